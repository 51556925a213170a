// What pose_at looks up instead of computing it anew for every frame: sway series filtered once, motion read once.
#pragma once
#include <vector>

#include "sim/motion_record.hpp"
#include "sim/wind.hpp"

namespace understory {

struct SpeciesSway {
  ModalSeries trunk, branch;  // tip angles at flexibility 1, radians
  ModalSeries flutter;        // how hard the leaves are driven: the wind's pressure smoothed over a second, as an angle
  double leaf_frequency = 0;  // Hz
  /// Per limb of the prototype: the wind's pressure at its height over that at the height the series are for.
  std::vector<double> exposure;
};

struct Dynamics {
  std::vector<SpeciesSway> species;   // per Scene::species; empty series where no plant uses it
  std::vector<ModalSeries> grass;     // per World::grass
  std::vector<MotionRecord> records;  // per Scene::occluders; no tracks: keyframes move the parts
};

}  // namespace understory
