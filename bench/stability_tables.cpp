// The stability of methods that look V up or need no crown: ground under grass, grass, baked crowns, the dome, and how
// the terms of a frame are combined.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include "bench/stability_case.hpp"
#include "host/passes/ambient.hpp"
#include "host/passes/check_fragments.hpp"
#include "host/passes/combine.hpp"
#include "host/passes/crown_baked.hpp"
#include "host/passes/crown_field.hpp"
#include "host/passes/grass_height.hpp"
#include "host/passes/grass_transmittance.hpp"
#include "host/passes/open_dome.hpp"
#include "kernels/shared/crown_baked.h"
#include "tests/reference/crown_baked.hpp"
#include "tests/reference/crown_field.hpp"
#include "tests/reference/grass_height.hpp"
#include "tests/reference/grass_transmittance.hpp"

namespace understory {
namespace {

constexpr float denormal = 1e-44f;

/// Owners: 0 background, then one of each of these.
OwnerTables owners_of(Device& device, std::initializer_list<SurfaceClass> surfaces) {
  std::vector<Owner> owners(1);
  for (const SurfaceClass surface : surfaces) {
    owners.emplace_back();
    owners.back().surface = surface;
  }
  return upload_owners(device, owners);
}

class TableCases {
 public:
  explicit TableCases(std::size_t samples) : samples_(samples) {}

  StabilityCase& add(const std::string& kernel, const std::string& name, std::vector<TestFragment> fragments,
                     const FragmentModel& model) {
    all.push_back(fragment_case(kernel, name, std::move(fragments), model));
    return all.back();
  }

  /// `garbage` shades what is no number; bounds only.
  void add_garbage(const std::string& kernel, FragmentModel model) {
    model.exact = nullptr;
    add(kernel, "zero, NaN and infinite numbers", garbage(2), model);
  }

  void add_open_dome() {
    const FragmentModel model{
        [](Device& device, FragmentPlanes& planes, Buffer<float>& out) { OpenDomePass(device).run(planes, out); },
        [](const ExactFragment& f) { return reference::open_dome(f.normal.z); }};
    std::vector<TestFragment> any, order;
    for (const glm::vec3 n : stability_directions(samples_)) any.push_back({glm::vec3(0), n});
    std::vector<std::size_t> rising;
    for (int i = -100; i <= 100; ++i) {
      const float z = 0.01f * static_cast<float>(i);
      rising.push_back(order.size());
      order.push_back({glm::vec3(0), {std::sqrt(std::max(1 - z * z, 0.0f)), 0, z}});
    }
    add("open-dome", "any normal", any, model).extreme = false;
    add("open-dome", "rising as the normal turns up", order, model).rising = {rising};
    add_garbage("open-dome", model);
  }

  void add_grass_height() {
    const FragmentModel model{[](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
                                GrassHeightPass(device).run(planes, owners_of(device, {SurfaceClass::blade}), out);
                              },
                              [](const ExactFragment& f) { return reference::grass_height(f.height, f.blade_length); }};
    const auto blade = [](double height, double length) {
      TestFragment f;
      f.owner = 1;
      f.height = static_cast<float>(height);
      f.blade_length = static_cast<float>(length);
      return f;
    };
    std::vector<TestFragment> ordinary, extreme, ends, order;
    for (std::size_t i = 0; i < samples_; ++i) {
      Random random = case_random("blade", i);
      const double length = random.uniform(0.05, 3);
      ordinary.push_back(blade(length * random.uniform(-0.1, 1.1), length));
    }
    for (const double length : {0.0, 1e-44, 1e-38, 1e-31, 1e-30, 1e-6, 1.0, 1e6, 1e30, 3e38})
      for (const double share : {-1.0, 0.0, 1e-30, 0.25, 1.0, 2.0}) extreme.push_back(blade(length * share, length));
    std::vector<std::pair<std::size_t, std::size_t>> neighbours;
    for (const float length : {1e-30f, 1e-6f, 1.0f, 1e6f})
      for (const float height : {0.0f, length})
        for (const float towards : {-1e30f, 1e30f}) {
          neighbours.push_back({ends.size(), ends.size() + 1});
          ends.push_back(blade(double(height), double(length)));
          ends.push_back(blade(double(std::nextafter(height, towards)), double(length)));
        }
    std::vector<std::size_t> rising;
    for (int i = -10; i <= 110; ++i) {
      rising.push_back(order.size());
      order.push_back(blade(0.01 * i * 0.7, 0.7));
    }
    add("grass-height", "ordinary blades", ordinary, model).extreme = false;
    add("grass-height", "blades of 0 to 3e38 m", extreme, model);
    add("grass-height", "root and tip, one unit in the last place", ends, model).neighbours = neighbours;
    add("grass-height", "rising with the height", order, model).rising = {rising};
    add_garbage("grass-height", model);
  }

  void add_grass_transmittance() {
    for (const bool open_below : {false, true}) {
      const auto layer = std::make_shared<GrassLayer>();
      layer->extent = {glm::dvec2(-4), glm::dvec2(4)};
      layer->columns = layer->rows = 16;
      layer->levels = 5;
      layer->level_height = 0.25;
      for (std::size_t i = 0; i < 256; ++i) {
        Random random = case_random("column", i);
        layer->ground.push_back(static_cast<float>(std::round(64 * random.uniform(0, 0.3)) / 64));
        for (std::uint32_t k = 0; k < layer->levels; ++k)
          layer->light.push_back({float(0.1 * (k + 1) * random.uniform()), float(0.05 * random.uniform()),
                                  float(random.uniform(-0.1, 0.1)), float(random.uniform(-0.1, 0.1)),
                                  open_below ? float(0.18 * random.uniform()) : 0});
      }
      const FragmentModel model{[layer, open_below](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
                                  GrassTransmittancePass(device, open_below)
                                      .run(planes, GrassLayerTable(device, *layer, open_below), glm::dvec3(0), out);
                                },
                                [layer, open_below](const ExactFragment& f) {
                                  return reference::grass_transmittance(*layer, f.position, f.normal, open_below);
                                }};
      std::vector<TestFragment> among, far;
      for (std::size_t i = 0; i < samples_; ++i) {
        Random random = case_random("among grass", i);
        TestFragment f;
        f.position = glm::vec3(random.uniform(-3.7, 3.7), random.uniform(-3.7, 3.7), random.uniform(-0.1, 0.95));
        f.normal = random_direction(random);
        if (f.normal.z < -0.9f) f.normal.z = -f.normal.z;  // there the divisor is 0.01 instead of the dome
        among.push_back(f);
        f.position *= std::pow(10.0f, static_cast<float>(random.uniform(1, 37)));
        far.push_back(f);
      }
      const std::string kernel = open_below ? "grass-transmittance/below" : "grass-transmittance";
      add(kernel, "places among grass", among, model).extreme = false;
      add(kernel, "far outside", far, model);
      add_garbage(kernel, model);
    }
  }

  void add_ambient() {
    const auto cover = std::make_shared<GroundCover>();
    cover->extent = {glm::dvec2(-8), glm::dvec2(8)};
    cover->columns = cover->rows = 16;
    for (std::size_t i = 0; i < 256; ++i)
      cover->visibility.push_back(static_cast<float>(case_random("cover", i).uniform()));
    const FragmentModel model{
        [cover](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
          const OwnerTables owners = owners_of(device, {SurfaceClass::terrain, SurfaceClass::leaf});
          AmbientPass(device).run(planes, owners, 0.375, class_bit(SurfaceClass::leaf),
                                  GroundCoverTable(device, *cover), glm::dvec3(0), out);
        },
        [cover](const ExactFragment& f) {
          if (f.owner != 1) return f.owner == 2 ? 0.375 : 1.0;
          const glm::dvec2 p(f.position);
          if (!cover->extent.contains(p)) return 1.0;
          const glm::dvec2 at = glm::clamp(p + 7.5, glm::dvec2(0), glm::dvec2(15));
          double v = 0;
          for (int row = 0; row < 16; ++row)
            for (int column = 0; column < 16; ++column)
              v += std::max(0.0, 1 - std::abs(at.x - column)) * std::max(0.0, 1 - std::abs(at.y - row)) *
                   double(cover->visibility[static_cast<std::size_t>(16 * row + column)]);
          return v;
        }};
    std::vector<TestFragment> ground, far;
    for (std::size_t i = 0; i < samples_; ++i) {
      Random random = case_random("ground", i);
      TestFragment f;
      f.position = glm::vec3(random.uniform(-9, 9), random.uniform(-9, 9), 0);
      f.owner = static_cast<std::uint32_t>(i % 3);
      ground.push_back(f);
      f.position *= std::pow(10.0f, static_cast<float>(random.uniform(-44, 37)));
      far.push_back(f);
    }
    add("ambient", "places on the ground", ground, model).extreme = false;
    add("ambient", "far outside and denormal", far, model);
    add_garbage("ambient", model);
  }

  void add_crown_field() {
    const CrownFieldGrid grid{-2, -1.5f, 0, 2, 8, 6, 16, 0};
    const auto cells = std::make_shared<std::vector<std::uint32_t>>(std::size_t{FIELD_WORDS} * 8 * 6 * 16);
    for (std::size_t i = 0; i < cells->size(); ++i)
      (*cells)[i] = static_cast<std::uint32_t>(case_random("cell", i).bits()) & 0x1f1f1f1fu;
    const FragmentModel model{
        [grid, cells](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
          planes.rest_position = {std::move(planes.position_x), std::move(planes.position_y),
                                  std::move(planes.position_z)};
          planes.rest_normal = {std::move(planes.normal_x), std::move(planes.normal_y), std::move(planes.normal_z)};
          for (Buffer<float>* plane : {&planes.position_x, &planes.position_y, &planes.position_z, &planes.normal_x,
                                       &planes.normal_y, &planes.normal_z})
            *plane = Buffer<float>(device, planes.padded_fragments, "not read");
          const std::vector<std::int32_t> owner_field{-1, 0, -1};
          CrownFieldTables tables;
          tables.owner_field = Buffer<std::int32_t>(device, std::span<const std::int32_t>(owner_field), "owner fields");
          tables.grids = Buffer<CrownFieldGrid>(device, std::span<const CrownFieldGrid>(&grid, 1), "grids");
          tables.cells = Buffer<std::uint32_t>(device, std::span<const std::uint32_t>(*cells), "cells");
          CrownFieldPass(device).run(planes, tables, out);
        },
        [grid, cells](const ExactFragment& f) {
          // Cells do not meet: on a border between two, rounding decides.
          const glm::dvec3 place = (f.position - glm::dvec3(grid.low_x, grid.low_y, grid.low_z)) * 2.0;
          const glm::dvec3 off = glm::abs(place - glm::round(place));
          if (std::min({off.x, off.y, off.z}) < 1e-5) return std::nan("");
          return f.owner == 1 ? reference::crown_field(grid, *cells, f.position, f.normal) : 1.0;
        }};
    std::vector<TestFragment> inside, far;
    for (std::size_t i = 0; i < samples_; ++i) {
      Random random = case_random("in the field", i);
      TestFragment f;
      f.position = glm::vec3(random.uniform(-2, 2), random.uniform(-1.5, 1.5), random.uniform(0, 8));
      f.normal = random_direction(random);
      f.owner = static_cast<std::uint32_t>(1 + i % 2);
      inside.push_back(f);
      f.position *= std::pow(10.0f, static_cast<float>(random.uniform(-44, 37)));
      far.push_back(f);
    }
    add("crown-field", "places in the crown", inside, model).extreme = false;
    add("crown-field", "far outside and denormal", far, model);
    add_garbage("crown-field", model);
  }

  void add_crown_baked() {
    std::vector<std::uint32_t> texels(777), at, place;
    for (std::size_t i = 0; i < texels.size(); ++i)
      texels[i] = static_cast<std::uint32_t>(case_random("texel", i).bits());
    for (std::size_t i = 0; i < samples_; ++i) {
      Random random = case_random("texel place", i);
      at.push_back(i % 7 == 6 ? NO_TEXEL : static_cast<std::uint32_t>(random.below(texels.size() + 40)));
      place.push_back(i % 5 == 4 ? (i % 2 ? 0xffffffffu : 0u) : static_cast<std::uint32_t>(random.bits()));
    }
    const FragmentModel model{[=](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
      std::vector<std::uint32_t> all_at = at, all_places = place;
      all_at.resize(planes.padded_fragments, 0xdeadbeefu);
      all_places.resize(planes.padded_fragments, 0xdeadbeefu);
      allocate_texel_planes(device, planes);
      planes.texel.write(all_at);
      planes.texel_place.write(all_places);
      const Buffer<std::uint32_t> table(device, std::span<const std::uint32_t>(texels), "texels");
      CrownBakedPass(device).run(planes, table, out);
    }};
    StabilityCase& one =
        add("crown-baked", "every kind of texel, place and missing texel", std::vector<TestFragment>(samples_), model);
    one.extreme = false;
    one.exact = [=](std::size_t i) {
      return at[i] < texels.size() ? reference::texel_visibility(texels[at[i]], place[i]) : 1;
    };
  }

  /// Terms are the planes of normals and positions, which hold anything; each is limited to [0, 1], NaN to 1.
  void add_combine() {
    for (const bool limit : {false, true}) {
      const auto limited = [](double v) { return std::isnan(v) ? 1.0 : std::clamp(v, 0.0, 1.0); };
      const FragmentModel model{
          [limit](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
            VisibilityTerms terms;
            terms.ambient = &planes.position_x;
            terms.tree = &planes.position_y;
            terms.crowns = &planes.normal_x;
            terms.dome = &planes.normal_y;
            terms.near = &planes.normal_z;
            terms.near_is_limit = limit;
            CombinePass(device).run(planes, owners_of(device, {SurfaceClass::leaf, SurfaceClass::wood}), terms, out);
          },
          [=](const ExactFragment& f) {
            const double v = limited(f.position.x) * limited(f.position.y) * limited(f.normal.x) * limited(f.normal.y);
            return limit ? std::min(v, limited(f.normal.z)) : v * limited(f.normal.z);
          }};
      std::vector<TestFragment> terms;
      for (std::size_t i = 0; i < samples_; ++i) {
        Random random = case_random("terms", i);
        const auto term = [&] { return static_cast<float>(random.uniform(-0.1, 1.1)); };
        terms.push_back({{term(), term(), 0}, {term(), term(), term()}});
      }
      const std::string kernel = limit ? "combine/minimum" : "combine/product";
      add(kernel, "terms in and a little beyond [0, 1]", terms, model).extreme = false;
      add(kernel, "zero, NaN and infinite terms", garbage(1), model);
    }
  }

  /// Values are half the length of the normal that later passes see: 1/2.
  void add_check_fragments() {
    const FragmentModel model{
        [](Device& device, FragmentPlanes& planes, Buffer<float>& out) {
          CheckFragmentsPass(device).run(planes);
          const std::vector<float> x = planes.normal_x.read(), y = planes.normal_y.read(), z = planes.normal_z.read();
          const std::vector<std::uint32_t> codes = planes.validity.read();
          std::vector<float> half(x.size());
          for (std::size_t i = 0; i < half.size(); ++i)
            half[i] = codes[i] & validity::not_finite ? 0.5f  // flagged: every pass leaves it open
                                                      : 0.5f * glm::length(glm::vec3(x[i], y[i], z[i]));
          out.write(half);
        },
        [](const ExactFragment&) { return 0.5; }};
    std::vector<TestFragment> normals = garbage(1);
    for (const glm::vec3 n : stability_directions(100))
      for (const float length : {denormal, 1e-29f, 1e-12f, 0.5f, 1.1f, 1e12f, 1e30f, 2e38f})
        normals.push_back({glm::vec3(1), n * length});
    add("check-fragments", "normals of any length become unit", normals, model);
  }

  std::vector<StabilityCase> all;

 private:
  std::size_t samples_;
};

}  // namespace

std::vector<StabilityCase> table_stability(std::size_t samples) {
  TableCases cases(samples);
  cases.add_open_dome();
  cases.add_grass_height();
  cases.add_grass_transmittance();
  cases.add_ambient();
  cases.add_crown_field();
  cases.add_crown_baked();
  cases.add_combine();
  cases.add_check_fragments();
  return std::move(cases.all);
}

}  // namespace understory
