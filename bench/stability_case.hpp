// One thing that `understory stability` tries: many values of V from one kernel, what they should be in double, and
// what must hold between them.
#pragma once
#include <functional>
#include <glm/glm.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/test_fragments.hpp"

namespace understory {

struct StabilityCase {
  std::string kernel, name;
  bool extreme = true;            // outside the normal domain: a wider bar
  double stated_error = 0;        // of the model's tables and fits, beside the bar
  double stated_jump = 0;         // of the model, where it passes from one form to another
  std::string note;               // what the stated numbers are of, and where they are stated
  std::string conditioning = {};  // why units in the last place of the inputs matter, where they do
  std::function<Shaded(Device&)> shade;
  /// V in double with exact transcendental functions; NaN where nothing can be compared. Empty: bounds only.
  std::function<double(std::size_t)> exact = {};
  /// How far the exact V moves when a value's vectors move by one unit in the last place of their largest component:
  /// what no float kernel can know better. Empty: 0.
  std::function<double(std::size_t)> last_place = {};
  std::vector<std::pair<std::size_t, std::size_t>> neighbours =
      {};                                             // one unit in the last place apart, across a branch
  std::vector<std::vector<std::size_t>> rising = {};  // V must not fall along any of these
};

/// A fragment in double.
struct ExactFragment {
  glm::dvec3 position{0}, normal{0, 0, 1};
  double height = 0, blade_length = 0;
  std::uint32_t owner = 0;
  explicit ExactFragment(const TestFragment& f);
};

/// A kernel that shades fragments one by one, and what it computes.
struct FragmentModel {
  std::function<void(Device&, FragmentPlanes&, Buffer<float>&)> shade;
  std::function<double(const ExactFragment&)> exact = {};
};

/// `shade` and `exact` filled in, and `last_place` by moving each coordinate of a fragment. `apart`: elements of the
/// planes from one fragment to the next, background between them: 128 puts each into a tile of its own.
StabilityCase fragment_case(const std::string& kernel, const std::string& name, std::vector<TestFragment> fragments,
                            const FragmentModel& model, std::size_t apart = 1);

/// What the cases of each group of kernels are; `samples`: fragments of a case made by chance.
std::vector<StabilityCase> crown_stability(std::size_t samples);
std::vector<StabilityCase> transmittance_stability(std::size_t samples);
std::vector<StabilityCase> sphere_stability(std::size_t samples);
std::vector<StabilityCase> grid_stability(std::size_t samples);
std::vector<StabilityCase> table_stability(std::size_t samples);
std::vector<StabilityCase> image_stability(std::size_t samples);
std::vector<StabilityCase> pose_stability();
std::vector<StabilityCase> frame_stability();

/// A float that double holds too.
inline double as_float(double value) { return static_cast<double>(static_cast<float>(value)); }

/// A number per case made by chance, the same every time.
inline Random case_random(const std::string& what, std::size_t index = 0) { return Random(17, stream_of(what), index); }

/// Unit in float as near as can be: directions along the axes, in their planes, and by chance.
std::vector<glm::vec3> stability_directions(std::size_t by_chance);

}  // namespace understory
