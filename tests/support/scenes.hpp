// Small scenes that several tests start from.
#pragma once
#include <string>

#include "sim/scene.hpp"

namespace understory {

inline SpeciesSource small_species(const std::string& generator, int leaves = 400) {
  SpeciesSource species;
  species.name = generator;
  species.generator = generator;
  species.leaves = leaves;
  return species;
}

/// One plant of a species at a place, on flat ground, without grass or occluders.
inline Scene one_plant(const SpeciesSource& species, glm::dvec2 at = glm::dvec2(0)) {
  Scene scene;
  scene.name = "one plant";
  scene.species.push_back(species);
  PlantPlacement placement;
  placement.species = species.name;
  placement.spots.push_back({at, 0.3, 1});
  scene.plants.push_back(placement);
  return scene;
}

/// Two species, a scatter and a spot, two fields of grass, a ball and a body of two parts.
inline Scene small_meadow() {
  Scene scene = one_plant(small_species("birch"), {-12, 3});
  scene.species.push_back(small_species("shrub"));
  PlantPlacement shrubs;
  shrubs.species = "shrub";
  shrubs.scatter = true;
  shrubs.region = {{-20, -20}, {20, 20}};
  shrubs.spacing = 9;
  shrubs.count = 7;
  scene.plants.push_back(shrubs);
  for (double x : {-10.0, 5.0}) {
    GrassField field;
    field.region = {{x, -3}, {x + 4, 3.5}};
    field.density = 50;
    scene.grass.push_back(field);
  }
  OccluderSource ball;
  ball.name = "ball";
  ball.parts.push_back({"ball", OccluderPart::Shape::ellipsoid, glm::dvec3(0.8), {}, {}, UpAxis::y, 1, {}, {}});
  ball.keyframes = {{0, {-5, 0, 0.4}, {0, 0, 0}}, {2, {5, 1, 0.4}, {0, 3, 0}}, {4, {9, 4, 0.4}, {0, 6, 1}}};
  OccluderSource animal;
  animal.name = "animal";
  animal.parts.push_back({"body", OccluderPart::Shape::ellipsoid, {1.6, 0.6, 0.7}, {}, {}, UpAxis::y, 1, {}, {}});
  animal.parts.push_back(
      {"leg",
       OccluderPart::Shape::capsule,
       {0.15, 0.15, 0.9},
       {},
       {},
       UpAxis::y,
       1,
       {{0, {0.5, 0, -0.6}, {0, -0.4, 0}}, {0.5, {0.5, 0, -0.6}, {0, 0.4, 0}}, {1, {0.5, 0, -0.6}, {0, -0.4, 0}}},
       {}});
  animal.keyframes = {{0, {0, -6, 1}, {0, 0, 0}}, {10, {0, 6, 1}, {0, 0, 0.5}}};
  scene.occluders = {ball, animal};
  return scene;
}

}  // namespace understory
