// Per face and side: least squares for the values on a lattice over the face, from rays that start all over it.
//   minimise  sum_s (y_s - h_s.x)^2 / noise  +  mean_i d_i^2 / tau_field^2  +  sum_edges (d_i - d_j)^2 / tau_step^2
// x: values at lattice points, h_s: their bilinear weights at the start of ray s, y_s: 1 where it is free,
// d = x - field: deviation from the plant's smooth field, whose error is known by measurement.
#include "host/trace/crown_baked.hpp"

#include <tbb/parallel_for.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/trace/crown_field.hpp"
#include "host/trace/directions.hpp"
#include "host/trace/rest_surface.hpp"
#include "kernels/shared/crown_baked.h"
#include "sim/random.hpp"

namespace understory {
namespace {

constexpr double tau_field = 0.1;  // deviation of a face from the field
constexpr double tau_step = 0.12;  // from lattice point to lattice point
constexpr int most_edge = 32, most_texels = 64;
constexpr std::size_t first_rays = 32;  // none of them free: nobody sees this side

struct Lattice {
  int columns = 1, rows = 1;
  int points() const { return (columns + 1) * (rows + 1); }
};

/// Texels of about `edge` metres.
Lattice lattice_of(const RestSurface& surface, std::size_t triangle, double edge) {
  const glm::vec3 a = surface.corner(triangle, 0);
  const auto count = [&](int corner) {
    const double length = double(glm::length(surface.corner(triangle, corner) - a));
    return static_cast<int>(std::clamp(std::ceil(length / edge - 0.5), 1.0, double(most_edge)));
  };
  Lattice lattice{count(1), count(2)};
  while (lattice.columns * lattice.rows > most_texels)
    (lattice.columns > lattice.rows ? lattice.columns : lattice.rows) -= 1;
  return lattice;
}

std::size_t texels_at(const RestSurface& surface, double edge) {
  std::size_t sum = 0;
  for (std::size_t i = 0; i < surface.triangle_count(); ++i) {
    const Lattice lattice = lattice_of(surface, i, edge);
    sum += static_cast<std::size_t>(lattice.columns * lattice.rows);
  }
  return sum;
}

/// Edge of texels, m, at which there are at most `wanted` of them; by bisection.
double texel_edge(const RestSurface& surface, double wanted, double largest) {
  double low = largest * 1e-4, high = largest;
  for (int step = 0; step < 20; ++step) {
    const double middle = std::sqrt(low * high);
    (double(texels_at(surface, middle)) > wanted ? low : high) = middle;
  }
  return high;
}

/// A ray's start on the face, as shares u of corner b and v of corner c.
glm::vec2 even_place(std::uint32_t index, std::uint32_t seed) {
  const glm::vec2 u = scrambled_sobol(index, seed);
  const float root = std::sqrt(u.x);
  return {root * (1 - u.y), root * u.y};
}

/// One side of a face while its values are fitted.
class FaceSide {
 public:
  FaceSide(const RestSurface& surface, const CrownField& field, std::size_t triangle, bool front, Lattice lattice)
      : a_(surface.corner(triangle, 0)),
        u_(surface.corner(triangle, 1) - a_),
        v_(surface.corner(triangle, 2) - a_),
        normal_(front ? surface.normal(triangle) : -surface.normal(triangle)),
        lattice_(lattice),
        square_(Eigen::MatrixXd::Zero(lattice.points(), lattice.points())),
        product_(Eigen::VectorXd::Zero(lattice.points())),
        field_(lattice.points()) {
    for (int row = 0; row <= lattice.rows; ++row)
      for (int column = 0; column <= lattice.columns; ++column) {
        glm::vec2 place(static_cast<float>(column) / static_cast<float>(lattice.columns),
                        static_cast<float>(row) / static_cast<float>(lattice.rows));
        place /= std::max(place.x + place.y, 1.0f);  // lattice points beyond the face: from its edge
        field_[number(column, row)] = field_visibility(field, point(place).position, normal_);
      }
  }

  SurfacePoint point(glm::vec2 place) const { return {a_ + place.x * u_ + place.y * v_, normal_}; }
  glm::vec3 direction(glm::vec2 random) const { return frame_about(normal_) * cosine_hemisphere(random); }

  /// `visibility`: mean of `rays` rays from one place.
  void add(glm::vec2 place, double visibility, double rays) {
    const float x = place.x * static_cast<float>(lattice_.columns), y = place.y * static_cast<float>(lattice_.rows);
    const int column = std::min(static_cast<int>(x), lattice_.columns - 1);
    const int row = std::min(static_cast<int>(y), lattice_.rows - 1);
    const double fx = double(x) - column, fy = double(y) - row;
    const int points[] = {number(column, row), number(column + 1, row), number(column, row + 1),
                          number(column + 1, row + 1)};
    const double weights[] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
    for (int i = 0; i < 4; ++i) {
      for (int j = 0; j < 4; ++j) square_(points[i], points[j]) += rays * weights[i] * weights[j];
      product_[points[i]] += rays * weights[i] * visibility;
    }
    sum_ += rays * visibility;
    count_ += rays;
  }

  /// Values at the lattice points.
  Eigen::VectorXd fit() const {
    const double mean = (sum_ + field_.mean()) / (count_ + 1);
    const double noise = std::max(mean * (1 - mean), 0.01);  // of one ray
    Eigen::MatrixXd square = square_;
    square.diagonal().array() += noise / (tau_field * tau_field) / lattice_.points();
    const double step = noise / (tau_step * tau_step);
    const auto join = [&](int i, int j) {
      square(i, i) += step;
      square(j, j) += step;
      square(i, j) -= step;
      square(j, i) -= step;
    };
    for (int row = 0; row <= lattice_.rows; ++row)
      for (int column = 0; column <= lattice_.columns; ++column) {
        if (column < lattice_.columns) join(number(column, row), number(column + 1, row));
        if (row < lattice_.rows) join(number(column, row), number(column, row + 1));
      }
    return field_ + square.llt().solve(product_ - square_ * field_);
  }

  /// Texels row by row.
  void store(const Eigen::VectorXd& values, std::uint32_t* texels) const {
    const auto byte = [&](int column, int row) {
      const double steps = (values[number(column, row)] - double(TEXEL_LOWEST)) / double(TEXEL_STEP);
      return static_cast<std::uint32_t>(std::clamp(std::round(steps), 0.0, 255.0));
    };
    for (int row = 0; row < lattice_.rows; ++row)
      for (int column = 0; column < lattice_.columns; ++column)
        *texels++ = byte(column, row) | byte(column + 1, row) << 8 | byte(column, row + 1) << 16 |
                    byte(column + 1, row + 1) << 24;
  }

 private:
  int number(int column, int row) const { return row * (lattice_.columns + 1) + column; }

  glm::vec3 a_, u_, v_, normal_;
  Lattice lattice_;
  Eigen::MatrixXd square_;
  Eigen::VectorXd product_, field_;
  double sum_ = 0, count_ = 0;
};

/// Rays of a side: what each of them sees of the sky.
class RayBundle {
 public:
  explicit RayBundle(Sky sky) : sky_(sky) {}
  void add(const FaceSide& side, glm::vec2 place, glm::vec2 random) {
    places.push_back(place);
    starts_.push_back(side.point(place));
    directions_.push_back(side.direction(random));
  }
  /// Finds which rays get out.
  void trace(const RestSurface& surface) {
    open.resize(places.size());
    surface.open(starts_, directions_, open);
  }
  /// The same of rays that may meet sky only, less than half of them under the dome; `open` is not told of the others.
  void trace_towards_sky(const RestSurface& surface) {
    std::vector<SurfacePoint> starts;
    std::vector<glm::vec3> directions;
    for (std::size_t ray = 0; ray < places.size(); ++ray)
      if (may_see_sky(ray)) starts.push_back(starts_[ray]), directions.push_back(directions_[ray]);
    std::vector<std::uint8_t> found(starts.size());
    surface.open(starts, directions, found);
    open.assign(places.size(), 0);
    for (std::size_t ray = 0, next = 0; ray < places.size(); ++ray)
      if (may_see_sky(ray)) open[ray] = found[next++];
  }
  double sees_sky(std::size_t ray) const { return open[ray] && may_see_sky(ray) ? 1 : 0; }

  std::vector<glm::vec2> places;
  std::vector<std::uint8_t> open;

 private:
  bool may_see_sky(std::size_t ray) const { return sky_ == Sky::sphere || directions_[ray].z > 0; }

  Sky sky_;
  std::vector<SurfacePoint> starts_;
  std::vector<glm::vec3> directions_;
};

/// Every ray counts: `first` to `last` - 1 of the side's rays. `asked`: whether one of them got out, to anywhere.
bool sample_everywhere(const RestSurface& surface, FaceSide& side, std::size_t first, std::size_t last, Sky sky,
                       std::uint32_t seed, bool asked) {
  RayBundle bundle(sky);
  for (std::size_t i = first; i < last; ++i) {
    const auto index = static_cast<std::uint32_t>(i);
    bundle.add(side, even_place(index, seed), scrambled_sobol(index, seed + 1));
  }
  if (asked)
    bundle.trace(surface);
  else
    bundle.trace_towards_sky(surface);
  for (std::size_t ray = 0; ray < bundle.places.size(); ++ray) side.add(bundle.places[ray], bundle.sees_sky(ray), 1);
  return asked && std::find(bundle.open.begin(), bundle.open.end(), 1) != bundle.open.end();
}

/// Only places that are seen count: those whose first ray gets out. Returns the rays spent.
std::size_t sample_where_seen(const RestSurface& surface, FaceSide& side, std::size_t rays, Sky sky,
                              std::uint32_t seed) {
  constexpr std::size_t per_place = 3;
  constexpr std::size_t hardly = 64;  // one of so many
  std::size_t spent = 0, seen = 0;
  for (std::uint32_t index = 0; spent < rays;) {
    RayBundle views(sky), more(sky);
    const std::size_t round = index == 0 ? first_rays : std::max<std::size_t>((rays - spent) / 2, 16);
    for (std::size_t i = 0; i < round; ++i, ++index)
      views.add(side, even_place(index, seed), scrambled_sobol(index, seed + 1));
    views.trace(surface);
    for (std::size_t view = 0; view < round; ++view)
      if (views.open[view])
        for (std::size_t i = 0; i < per_place; ++i)
          more.add(side, views.places[view],
                   scrambled_sobol(static_cast<std::uint32_t>(seen * per_place + more.places.size()), seed + 2));
    more.trace_towards_sky(surface);
    for (std::size_t ray = 0; ray < more.places.size(); ray += per_place) {
      double sum = 0;
      for (std::size_t i = 0; i < per_place; ++i) sum += more.sees_sky(ray + i);
      side.add(more.places[ray], sum / per_place, per_place);
    }
    seen += more.places.size() / per_place;
    spent += round + more.places.size();
    // Inside a stem. What is seen of it, if it is open somewhere, would say too little about the rest.
    if (index >= hardly && seen * hardly < index) {
      sample_everywhere(surface, side, 0, first_rays, sky, seed + 3, false);
      return spent + first_rays;
    }
  }
  return spent;
}

/// Stems run into each other, so that parts of a face may lie inside wood, where nobody sees them: on wood only places
/// that are seen count. Leaves are thin: all of them counts. Returns the rays spent.
std::size_t sample_side(const RestSurface& surface, FaceSide& side, bool wood, std::size_t rays, Sky sky,
                        std::uint32_t seed) {
  if (wood) return sample_where_seen(surface, side, rays, sky, seed);
  const std::size_t first = std::min(rays, first_rays);
  if (!sample_everywhere(surface, side, 0, first, sky, seed, true) || rays <= first_rays) return first;
  sample_everywhere(surface, side, first_rays, rays, sky, seed, false);
  return rays;
}

std::vector<SurfaceClass> classes_of(const Prototype& prototype) {
  std::vector<SurfaceClass> classes(prototype.triangle_count(), SurfaceClass::wood);
  for (const TriangleRun& run : prototype.runs) std::fill_n(classes.begin() + run.first, run.count, run.surface);
  return classes;
}

}  // namespace

CrownBaked bake_crown_faces(const Prototype& prototype, const CrownBakedOptions& options) {
  CrownFieldOptions field_options;
  field_options.sky = options.sky;
  field_options.seed = options.seed;
  const CrownField field = bake_crown_field(prototype, field_options);
  const RestSurface surface(prototype);
  const std::size_t count = surface.triangle_count();
  const double edge = texel_edge(surface, options.texels_per_triangle * double(count),
                                 double(glm::length(prototype.high - prototype.low)));
  CrownBaked baked;
  std::vector<Lattice> lattices;
  std::size_t texels = 0;
  double area = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const Lattice lattice = lattices.emplace_back(lattice_of(surface, i, edge));
    baked.faces.push_back(
        {static_cast<std::uint32_t>(texels), static_cast<std::uint32_t>(lattice.columns | lattice.rows << 8)});
    texels += 2 * static_cast<std::size_t>(lattice.columns * lattice.rows);
    area += double(surface.area(i));
  }
  baked.texels.assign(texels, 0);
  // Large faces fill more of a picture and have more texels: between the root of the area and the area itself.
  const double mean_area = std::max(area / double(std::max<std::size_t>(count, 1)), 1e-30);
  std::vector<double> share(count);
  double shares = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double relative = double(surface.area(i)) / mean_area;
    shares += share[i] = relative + std::sqrt(relative);
  }
  const double all_rays = std::min(options.rays_per_triangle * double(count), options.most_rays);
  const std::vector<SurfaceClass> classes = classes_of(prototype);
  tbb::parallel_for(std::size_t(0), count, [&](std::size_t i) {
    std::size_t rays = 2 * (static_cast<std::size_t>(all_rays / 2 * share[i] / shares) + 8);
    const std::size_t per_side = static_cast<std::size_t>(lattices[i].columns * lattices[i].rows);
    // Backs of stems are hidden: the fronts get what they leave.
    for (const bool front : {false, true}) {
      FaceSide side(surface, field, i, front, lattices[i]);
      const auto seed = static_cast<std::uint32_t>(mix_bits(2 * i + (front ? 0 : 1)) + options.seed);
      const bool wood = classes[i] == SurfaceClass::wood;
      rays -= std::min(rays, sample_side(surface, side, wood, front ? rays : rays / 2, options.sky, seed));
      side.store(side.fit(), &baked.texels[baked.faces[i][0] + (front ? 0 : per_side)]);
    }
  });
  return baked;
}

}  // namespace understory
