// Where rays go: a seeded low-discrepancy sequence in the unit square, and its maps onto directions.
#pragma once
#include <cstdint>
#include <glm/glm.hpp>

namespace understory {

/// Point `index` of the first two dimensions of the Sobol sequence in [0, 1)^2, Owen-scrambled and shuffled by a hash
/// of `seed` (Burley 2020, "Practical Hash-based Owen Scrambling"): every run of 2^k points from a multiple of 2^k is
/// stratified, different seeds are independent replicates.
glm::vec2 scrambled_sobol(std::uint32_t index, std::uint32_t seed);

/// Unit vectors with density 1/(4 pi).
glm::vec3 uniform_sphere(glm::vec2 u);
/// Unit vectors about +z with density cos/pi: the mean of visibility over them is V_c.
glm::vec3 cosine_hemisphere(glm::vec2 u);
/// Unit vectors about +z with density 1/(2 pi): the mean of visibility over them is V_u.
glm::vec3 uniform_hemisphere(glm::vec2 u);

/// Columns: two tangents and `normal` (unit); continuous except at normal.z = 0 crossings of sign (Duff et al. 2017).
glm::mat3 frame_about(glm::vec3 normal);

}  // namespace understory
