// The stability of occlusion grids: every rule of combining, sizes of 1 to 256 cells, empty and full, beside double.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bench/stability_case.hpp"
#include "bench/stability_exact_cones.hpp"
#include "host/passes/grid.hpp"
#include "host/passes/grid_cone.hpp"
#include "tests/support/grid_bodies.hpp"

namespace understory {
namespace {

struct GridMethod {
  std::string name, rule;  // rule: of cones; empty: a scalar grid
  bool paper = false;
  std::string label() const { return rule.empty() ? name : name + "/" + rule; }
};

/// A box of `size` samples, 2 m a side, with `share` and mean direction at every sample.
template <class Content>
OcclusionGrid box_grid(GridSize size, const Content& content) {
  OcclusionGrid grid;
  grid.size = size;
  grid.low = glm::vec3(-1);
  grid.high = glm::vec3(1);
  for (std::uint32_t z = 0; z < size[2]; ++z)
    for (std::uint32_t y = 0; y < size[1]; ++y)
      for (std::uint32_t x = 0; x < size[0]; ++x) {
        const ExactOccluded o = content(glm::dvec3(grid.position(x, y, z)));
        grid.share.push_back(static_cast<float>(o.share));
        grid.direction.push_back(glm::vec3(o.direction));
      }
  return grid;
}

/// What a ball of radius 0.35 m in the middle fills.
ExactOccluded ball(glm::dvec3 p) {
  const double d = std::max(glm::length(p), 1e-9), ratio = std::min(0.35 / d, 1.0);
  const double share = 0.5 * (1 - std::sqrt(1 - ratio * ratio));
  return {share, -p / d * share * (1 - share)};
}

OcclusionGrid ball_grid(std::uint32_t samples) {
  OcclusionGrid grid = box_grid({samples, samples, samples}, ball);
  open_border(grid, GridBorder::fade);
  return grid;
}

/// A body as the kernel sees it: its record's floats and the bytes of its samples.
struct ExactGrid {
  GridRecord record{};
  std::vector<std::uint8_t> bytes;  // four a sample: direction, share
  bool cone = false;
  std::int32_t group = -1;

  double byte_at(int channel, std::uint32_t x, std::uint32_t y, std::uint32_t z) const {
    const std::size_t sample = (std::size_t{z} * record.height + y) * record.width + x;
    return bytes[cone ? 4 * sample + static_cast<std::size_t>(channel) : sample];
  }

  /// Trilinear, of one channel; nothing outside the box.
  double mixed(int channel, const glm::dvec3& at) const {
    const glm::dvec3 last(record.width - 1, record.height - 1, record.depth - 1);
    const glm::dvec3 low = glm::min(glm::floor(at), last - 1.0), part = at - low;
    double sum = 0;
    for (std::uint32_t corner = 0; corner < 8; ++corner) {
      const glm::dvec3 side(corner & 1u, corner >> 1 & 1u, corner >> 2);
      const glm::dvec3 weight = side * part + (1.0 - side) * (1.0 - part), sample = low + side;
      sum += weight.x * weight.y * weight.z *
             byte_at(channel, static_cast<std::uint32_t>(sample.x), static_cast<std::uint32_t>(sample.y),
                     static_cast<std::uint32_t>(sample.z));
    }
    return sum;
  }

  bool look_up(glm::dvec3 position, ExactOccluded& o) const {
    glm::dvec3 at;
    for (int row = 0; row < 3; ++row) {
      at[row] = double(record.to_box[4 * row + 3]);
      for (int axis = 0; axis < 3; ++axis) at[row] += double(record.to_box[4 * row + axis]) * position[axis];
    }
    if (!glm::all(glm::lessThanEqual(glm::abs(at), glm::dvec3(1)))) return false;
    const glm::dvec3 last(record.width - 1, record.height - 1, record.depth - 1);
    const double stretch = double(record.stretch);
    at = 0.5 * last * (1.0 + at * (1 + stretch) / (1.0 + stretch * glm::abs(at)));
    o.share = mixed(cone ? 3 : 0, at) / 255;
    if (!cone) return true;
    glm::dvec3 mean;
    for (int axis = 0; axis < 3; ++axis) mean[axis] = (mixed(axis, at) - 128) / (4 * 127);
    for (int row = 0; row < 3; ++row) {
      o.direction[row] = 0;
      for (int axis = 0; axis < 3; ++axis) o.direction[row] += double(record.axes[4 * row + axis]) * mean[axis];
    }
    return true;
  }
};

std::shared_ptr<const std::vector<ExactGrid>> exact_grids(const std::vector<GridBody>& bodies, bool cone) {
  const auto all = std::make_shared<std::vector<ExactGrid>>();
  for (const GridBody& body : bodies)
    all->push_back({body.record(0), cone ? packed_cone(body.grid) : packed_share(body.grid), cone, body.group});
  return all;
}

double exact_scalar(const std::vector<ExactGrid>& bodies, const ExactFragment& f, double self_share) {
  double v = 1;
  for (const ExactGrid& body : bodies) {
    ExactOccluded o;
    if (!body.look_up(f.position, o)) continue;
    const bool own = f.owner >= 2 && static_cast<std::int32_t>(f.owner - 2) == body.group;
    const double border = double(body.record.border), traced = o.share * (1 - border) + border;
    v *= 1 - (own ? self_share * std::clamp(2 * traced - 1, 0.0, 1.0) : std::min(2 * o.share, 1.0));
  }
  return v;
}

FragmentModel model_of(const GridMethod& method, const std::vector<GridBody>& bodies, bool comparable = true) {
  FragmentModel model;
  model.shade = [=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
    const bool cone = !method.rule.empty();
    const GridTable grids = upload_grids(device, bodies, cone);
    const OwnerTables owners = body_owners(device, 8);
    if (cone)
      GridConePass(device, method.name, method.rule).run(planes, owners, grids, out);
    else
      GridPass(device, method.name).run(planes, owners, grids, out);
  };
  if (!comparable) return model;
  model.exact = [method, grids = exact_grids(bodies, !method.rule.empty())](const ExactFragment& f) {
    if (method.rule.empty()) return exact_scalar(*grids, f, method.paper ? 0.5 : 1);
    std::vector<ExactOccluded> occluded;
    ExactOccluded o;
    for (const ExactGrid& grid : *grids)
      if (grid.look_up(f.position, o)) occluded.push_back(o);
    return exact_grid_cone(occluded, glm::normalize(f.normal), method.rule, method.paper);
  };
  return model;
}

GridBody body_of(OcclusionGrid grid, glm::dvec3 position = glm::dvec3(0)) {
  GridBody body;
  body.grid = std::move(grid);
  body.position = position;
  return body;
}

std::vector<GridBody> bodies_by_chance(std::size_t count) {
  std::vector<GridBody> bodies;
  for (std::size_t i = 0; i < count; ++i) {
    Random random = case_random("body", i);
    GridBody body = body_of(ball_grid(static_cast<std::uint32_t>(8 + 3 * i)));
    body.rotation =
        glm::mat3_cast(glm::angleAxis(random.uniform(0, 6), glm::normalize(glm::dvec3(random_direction(random)))));
    body.position = glm::dvec3(random_direction(random)) * 0.8;
    bodies.push_back(body);
  }
  return bodies;
}

std::vector<TestFragment> within(double reach, std::size_t count, glm::dvec3 centre = glm::dvec3(0)) {
  std::vector<TestFragment> all;
  for (std::size_t i = 0; i < count; ++i) {
    Random random = case_random("in grid", i);
    TestFragment f;
    f.position =
        glm::vec3(centre + reach * glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)));
    f.normal = random_direction(random);
    f.owner = 1;
    all.push_back(f);
  }
  return all;
}

class GridCases {
 public:
  GridCases(const GridMethod& method, std::size_t samples) : method_(method), samples_(samples) {}

  StabilityCase& add(const std::string& name, const std::vector<TestFragment>& fragments, const FragmentModel& model) {
    all.push_back(fragment_case(method_.label(), name, fragments, model));
    return all.back();
  }

  void add_sizes() {
    StabilityCase& ordinary = add("a body", within(1, samples_), model_of(method_, {body_of(ball_grid(32))}));
    ordinary.extreme = false;
    StabilityCase& several = add("six bodies", within(1.5, samples_ / 2), model_of(method_, bodies_by_chance(6)));
    several.extreme = false;
    for (const GridSize size : {GridSize{2, 2, 2}, GridSize{3, 2, 5}, GridSize{257, 3, 2}}) {
      const std::string cells = std::to_string(size[0] - 1) + " x " + std::to_string(size[1] - 1) + " x " +
                                std::to_string(size[2] - 1) + " cells";
      Random random = case_random("cells", size[0]);
      const auto wild = [&](glm::dvec3) {
        const double share = random.uniform();
        return ExactOccluded{share, glm::dvec3(random_direction(random)) * (share * (1 - share))};
      };
      add(cells, within(1, samples_ / 4), model_of(method_, {body_of(box_grid(size, wild))}));
    }
  }

  void add_contents() {
    for (const double share : {0.0, 0.5, 1.0}) {
      const auto even = [&](glm::dvec3) { return ExactOccluded{share, glm::dvec3(0, 0, share * (1 - share))}; };
      add("aperture " + std::to_string(share).substr(0, 3), within(0.99, samples_ / 4),
          model_of(method_, {body_of(box_grid({4, 4, 4}, even))}));
    }
    const auto scattered = [](glm::dvec3) { return ExactOccluded{0.5, glm::dvec3(0)}; };
    add("no direction", within(0.99, samples_ / 4), model_of(method_, {body_of(box_grid({4, 4, 4}, scattered))}));
    const auto solid = [](glm::dvec3 p) { return glm::length(p) < 0.6 ? ExactOccluded{1, glm::dvec3(0)} : ball(p); };
    add("in and about the solid", within(0.9, samples_ / 2),
        model_of(method_, {body_of(box_grid({17, 16, 18}, solid))}));
    // Cones in one direction, none or a few: where cones and planes touch.
    std::vector<TestFragment> tilted;
    for (const glm::vec3 n : stability_directions(60)) {
      TestFragment f;
      f.normal = n;
      f.owner = 1;
      tilted.push_back(f);
    }
    for (const double share : {1e-3, 0.01, 0.25, 0.75, 0.99}) {
      const auto narrow = [&](glm::dvec3) { return ExactOccluded{share, glm::dvec3(0, share * (1 - share), 0)}; };
      const GridBody body = body_of(box_grid({2, 2, 2}, narrow));
      StabilityCase& twice = add("cones of share " + std::to_string(share).substr(0, 5) + ", twice", tilted,
                                 model_of(method_, {body, body}));
      if (method_.rule != "merge") continue;
      twice.stated_error = 4e-4;
      twice.note = "axes nearer than sqrt(2^-23) = 3.5e-4 rad are not told apart by their cosine";
    }
  }

  void add_places() {
    std::vector<TestFragment> faces;
    std::vector<std::pair<std::size_t, std::size_t>> neighbours;
    for (const glm::vec3 n : stability_directions(4))
      for (int axis = 0; axis < 3; ++axis)
        for (const float side : {-1.0f, 1.0f, 0.0f, 0.5f})
          for (const float towards : {-10.0f, 10.0f}) {
            TestFragment on;
            on.normal = n;
            on.owner = 1;
            on.position = glm::vec3(0.3f, -0.2f, 0.4f);
            on.position[axis] = side;
            TestFragment off = on;
            off.position[axis] = std::nextafter(side, towards);
            neighbours.push_back({faces.size(), faces.size() + 1});
            faces.push_back(on);
            faces.push_back(off);
          }
    StabilityCase& rims = add("on the faces and between cells", faces, model_of(method_, {body_of(ball_grid(33))}));
    rims.neighbours = neighbours;
    const glm::dvec3 far(1e7, -1e7, 1e7);
    add("coordinates at 1e7 m", within(30, samples_ / 4, far), model_of(method_, {body_of(ball_grid(9), far)}));
    all.back().note = "a 2 m box among coordinates of 1 m steps: its record's constant is rounded alike";
    add("far outside", within(3e38, samples_ / 4), model_of(method_, {body_of(ball_grid(9))}));
    std::vector<TestFragment> denormal = within(1e-40, samples_ / 4);
    add("denormal positions", denormal, model_of(method_, {body_of(ball_grid(9))}));
  }

  void add_many_and_garbage() {
    const GridBody one = body_of(ball_grid(5));
    std::vector<GridBody> many(10000, one);
    for (std::size_t i = 0; i < many.size(); ++i) {
      Random random = case_random("crowd", i);
      many[i].position = 0.9 * glm::dvec3(random_direction(random));
    }
    add("10,000 overlapping bodies", within(1, 32), model_of(method_, many));
    add("zero, NaN and infinite numbers", garbage(9), model_of(method_, bodies_by_chance(3), false));
    std::vector<GridBody> broken(3, one);
    broken[0].position.x = NAN;
    broken[1].rotation = glm::dmat3(0);
    broken[2].grid.high = glm::vec3(3e38f);
    add("bodies of no or infinite size", garbage(9), model_of(method_, broken, false));
  }

  std::vector<StabilityCase> all;

 private:
  GridMethod method_;
  std::size_t samples_;
};

}  // namespace

std::vector<StabilityCase> grid_stability(std::size_t samples) {
  const GridMethod methods[] = {{"grid", ""},
                                {"grid-self-paper", "", true},
                                {"grid-cone", "multiply"},
                                {"grid-cone", "simple"},
                                {"grid-cone", "merge"},
                                {"grid-cone", "union"},
                                {"grid-cone-paper", "multiply", true},
                                {"grid-cone-paper", "merge", true}};
  std::vector<StabilityCase> all;
  for (const GridMethod& method : methods) {
    GridCases cases(method, samples);
    cases.add_sizes();
    cases.add_contents();
    cases.add_places();
    cases.add_many_and_garbage();
    std::move(cases.all.begin(), cases.all.end(), std::back_inserter(all));
  }
  return all;
}

}  // namespace understory
