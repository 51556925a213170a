// How time and memory of a frame grow with triangles, instances and pixels.
#pragma once
#include <string>
#include <vector>

namespace understory {

struct GrowthPoint {
  double size = 0;  // million triangles drawn, or million pixels
  double instances = 0;
  double ms = 0;          // median wall time of a frame
  double device_mib = 0;  // most bytes of buffers at once
  double world_mib = 0;   // resident memory of the process above what it was before the world was built
};

/// y = first + slope x by least squares, and the largest ratio of the ys of two points over that of their xs: 1 and
/// below is no worse than linear.
struct LinearFit {
  double first = 0, slope = 0, worst_growth = 0;
};
LinearFit fit_line(const std::vector<double>& x, const std::vector<double>& y);

/// An even-aged wood seen whole from above, 800 x 500: 1, 2, ... `most_million` million triangles, all drawn
/// (`detail: culled`; nothing is out of view).
std::vector<GrowthPoint> measure_triangle_growth(int most_million);
/// The wood of 1 million triangles at 0.25, 0.5, ... `most` megapixels.
std::vector<GrowthPoint> measure_pixel_growth(double most);

}  // namespace understory
