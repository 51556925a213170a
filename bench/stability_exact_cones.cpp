// The kernels' text is compiled once more under another namespace, so that its arc tangent can be the library's; the
// polynomial's own double form keeps its name everywhere else.
#include "bench/stability_exact_cones.hpp"

#include <bit>
#include <cmath>
#include <cstdint>

#define understory exact_text
#define UNDERSTORY_ARC_TANGENT_H  // taken by the function below
#include "kernels/shared/limits.h"
namespace understory {
inline double arc_tangent(double y, double x) { return std::atan2(y, x); }
}  // namespace understory
#include "kernels/shared/running_cone.h"
#include "kernels/shared/seen_directions.h"
#undef understory

namespace understory {

double exact_grid_cone(const std::vector<ExactOccluded>& bodies, glm::dvec3 n, const std::string& rule, bool paper) {
  using namespace exact_text;
  const auto combine = rule == "simple" ? combine_simple : rule == "merge" ? combine_merge : combine_multiply;
  const auto visibility = rule == "simple"  ? visibility_simple
                          : rule == "merge" ? visibility_merge
                                            : visibility_multiply;
  RunningCone running = no_cone();
  SeenDirections seen;
  see_all(&seen);
  for (const ExactOccluded& body : bodies) {
    const Occluded here = {body.share, body.direction.x, body.direction.y, body.direction.z};
    const Cone cone = paper ? opaque_cone(here) : spread_cone(here);
    const RunningCone next = clip_cone(cone, n.x, n.y, n.z);
    if (next.cosine <= 1e-6) continue;
    combine(&running, next);
    cover(&seen, tangents_of(n.x, n.y, n.z), n.x, n.y, n.z, cone, next.cosine);
  }
  if (rule == "union") return as_visibility(share_seen(&seen));
  return as_visibility(visibility(running, n.x, n.y, n.z));
}

}  // namespace understory
