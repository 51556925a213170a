// Simple bodies for occluder parts, and the few spheres that stand for a part in the solid-angle methods.
#pragma once
#include <glm/glm.hpp>
#include <vector>

#include "sim/prototype.hpp"
#include "sim/scene.hpp"

namespace understory {

/// Closed, outward winding (counter-clockwise seen from outside), centred at the origin; sizes in metres, all > 0.
RawMesh::Part box_part(glm::dvec3 edges);
RawMesh::Part ellipsoid_part(glm::dvec3 diameters);
/// Along z: (diameter, diameter, whole length). A length below the diameter flattens the caps.
RawMesh::Part capsule_part(glm::dvec3 size);
/// Ellipses one above the other, joined by straight walls, flat at both ends. A section is (diameter in x, in y, z), z
/// increases; at least two.
RawMesh::Part stacked_part(const std::vector<glm::dvec3>& sections);

struct Sphere {
  glm::dvec3 centre{0};
  double radius = 0;  // m
};

/// Mean over all directions of the area of the shadow of the points' convex hull, m^2. For a convex body a quarter of
/// its surface (Cauchy). Averaged over 64 directions, a few parts in a thousand.
double mean_shadow_area(const std::vector<glm::vec3>& points);

/// One to four equal spheres in a row along the longest edge of the points' bounding box, as many as its edges suggest.
/// Together, the overlap aside, they cast the mean shadow of the points' convex hull, so that from afar they block as
/// much of the sky as the body does, averaged over directions. Empty for fewer than three points.
std::vector<Sphere> cover_with_spheres(const std::vector<glm::vec3>& points);

}  // namespace understory
