// The bake of crown-baked: shapes whose visibility is known, a shrub against traced truth, the same bytes always.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "host/trace/crown_baked.hpp"
#include "host/trace/truth.hpp"
#include "sim/plants/species.hpp"
#include "tests/reference/crown_baked.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/seen_surface.hpp"

namespace understory {
namespace {

Prototype prototype_of(std::vector<glm::vec3> positions, std::vector<std::uint32_t> triangles, SurfaceClass surface) {
  RawMesh mesh;
  mesh.parts.push_back({"part", "some", surface, std::move(positions), std::move(triangles)});
  return rigid_prototype("shape", mesh);
}

/// Shares of corners b and c at a point of a triangle.
glm::dvec2 place_on(const RestSurface& surface, std::uint32_t triangle, glm::vec3 point) {
  const glm::dvec3 a(surface.corner(triangle, 0)), u = glm::dvec3(surface.corner(triangle, 1)) - a;
  const glm::dvec3 v = glm::dvec3(surface.corner(triangle, 2)) - a, w = glm::dvec3(point) - a;
  const glm::dvec3 n = glm::cross(u, v);
  return {glm::dot(glm::cross(w, v), n) / glm::dot(n, n), glm::dot(glm::cross(u, w), n) / glm::dot(n, n)};
}

struct Errors {
  double rmse = 0, bias = 0;
};

Errors against_truth(const Prototype& prototype, const CrownBakedOptions& options, std::uint32_t rays) {
  const RestSurface surface(prototype);
  const SeenSurface seen = seen_surface(surface, prototype, rays);
  TruthOptions truth_options;
  truth_options.sky = options.sky;
  truth_options.rays = 256;
  const Truth truth = trace_truth(surface.tracer(), seen.positions, seen.normals, truth_options);
  const CrownBaked baked = bake_crown_faces(prototype, options);
  double square = 0, sum = 0;
  for (std::size_t i = 0; i < seen.positions.size(); ++i) {
    const std::uint32_t triangle = seen.triangles[i];
    const double v = reference::face_visibility(baked.texels, baked.faces[triangle], seen.front[i],
                                                place_on(surface, triangle, seen.positions[i]));
    const double error = v - double(truth.visibility[i]);
    square += error * error;
    sum += error;
  }
  const auto count = static_cast<double>(seen.positions.size());
  return {std::sqrt(square / count), sum / count};
}

TEST(CrownBakedBake, TopAndUndersideOfAPlateUnderTheDome) {
  const Prototype plate =
      prototype_of({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, {0, 1, 2, 0, 2, 3}, SurfaceClass::leaf);
  CrownBakedOptions options;
  options.rays_per_triangle = 4000;
  const CrownBaked baked = bake_crown_faces(plate, options);
  for (const auto& face : baked.faces) {
    EXPECT_NEAR(reference::face_visibility(baked.texels, face, true, {0.3, 0.3}), 1, 0.01);
    EXPECT_NEAR(reference::face_visibility(baked.texels, face, false, {0.3, 0.3}), 0, 0.01);
  }
}

TEST(CrownBakedBake, FloorAtTheFootOfALongWallSeesHalf) {
  // V_c of the floor at distance x from a wall of height h, endless: (1 + x / sqrt(x^2 + h^2)) / 2; half at the foot.
  const float h = 1, far_away = 30;
  const Prototype corner = prototype_of({{0, -far_away, 0},
                                         {2, -far_away, 0},
                                         {2, far_away, 0},
                                         {0, far_away, 0},
                                         {0, -far_away, h},
                                         {0, far_away, h},
                                         {0.5f, -1, 0.001f},
                                         {1.5f, -1, 0.001f},
                                         {0.5f, 1, 0.001f}},
                                        {0, 3, 4, 3, 5, 4, 6, 7, 8}, SurfaceClass::leaf);
  CrownBakedOptions options;
  options.rays_per_triangle = 20000;
  options.texels_per_triangle = 40;
  const CrownBaked baked = bake_crown_faces(corner, options);
  const RestSurface surface(corner);
  std::uint32_t triangle = 0;  // the small one, of the least area
  for (std::uint32_t i = 1; i < surface.triangle_count(); ++i)
    if (surface.area(i) < surface.area(triangle)) triangle = i;
  for (const glm::vec3 point : {glm::vec3(0.6f, -0.8f, 0), glm::vec3(0.9f, -0.5f, 0), glm::vec3(1.2f, -0.7f, 0)}) {
    const double exact = 0.5 * (1 + double(point.x) / std::hypot(double(point.x), double(h)));
    const bool up = surface.normal(triangle).z > 0;
    EXPECT_NEAR(reference::face_visibility(baked.texels, baked.faces[triangle], up, place_on(surface, triangle, point)),
                exact, 0.03);
  }
}

TEST(CrownBakedBake, ShrubIsNearTheTruthOfWhatIsSeen) {
  const Prototype shrub = build_species(small_species("shrub", 800), 4, nullptr).prototype;
  for (const Sky sky : {Sky::dome, Sky::sphere}) {
    CrownBakedOptions options;
    options.sky = sky;
    const Errors errors = against_truth(shrub, options, 2500);
    EXPECT_LE(errors.rmse, 0.05);
    EXPECT_NEAR(errors.bias, 0, 0.01);
  }
}

TEST(CrownBakedBake, CrossedCardsKeepTheirOpenParts) {
  // Two vertical cards through each other: at the crossing each hides half of the other's sky, at the rims little.
  std::vector<glm::vec3> positions;
  std::vector<std::uint32_t> triangles;
  for (const glm::vec3 along : {glm::vec3(1, 0, 0), glm::vec3(0, 1, 0)}) {
    const auto first = static_cast<std::uint32_t>(positions.size());
    for (const glm::vec3 p : {-along, along, along + glm::vec3(0, 0, 2), -along + glm::vec3(0, 0, 2)})
      positions.push_back(p + glm::vec3(0, 0, 1));
    for (const std::uint32_t corner : {0u, 1u, 2u, 0u, 2u, 3u}) triangles.push_back(first + corner);
  }
  CrownBakedOptions options;
  options.rays_per_triangle = 6000;
  options.texels_per_triangle = 24;
  EXPECT_LE(against_truth(prototype_of(positions, triangles, SurfaceClass::leaf), options, 4000).rmse, 0.04);
}

TEST(CrownBakedBake, GivesTheSameBytesOnOneThread) {
  const Prototype shrub = build_species(small_species("shrub", 300), 4, nullptr).prototype;
  CrownBakedOptions options;
  options.rays_per_triangle = 30;
  const CrownBaked many = bake_crown_faces(shrub, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const CrownBaked single = bake_crown_faces(shrub, options);
  EXPECT_EQ(single.faces, many.faces);
  EXPECT_EQ(single.texels, many.texels);
}

}  // namespace
}  // namespace understory
