#include "host/frame/thinning.hpp"

#include <algorithm>
#include <cmath>

namespace understory {

void thin(std::size_t units, double share, std::vector<float>& factors) {
  factors.clear();
  const double drawn = share * static_cast<double>(units);
  const double fading = std::max(fading_share * drawn, 1.0);
  double sum = 0;
  for (std::size_t unit = 0; unit < units; ++unit) {
    const double size = std::min((drawn - static_cast<double>(unit)) / fading, 1.0);
    if (size <= 0) break;
    factors.push_back(static_cast<float>(size));
    sum += size;
  }
  for (float& factor : factors) factor *= static_cast<float>(static_cast<double>(units) / sum);
}

}  // namespace understory
