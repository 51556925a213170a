// The bake of crown-field: shapes whose visibility is known, a shrub against traced truth, the same bytes always.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "host/trace/bake_cache.hpp"
#include "host/trace/crown_field.hpp"
#include "host/trace/rest_surface.hpp"
#include "host/trace/truth.hpp"
#include "sim/plants/species.hpp"
#include "tests/reference/crown_field.hpp"
#include "tests/support/scenes.hpp"
#include "tests/support/seen_surface.hpp"

namespace understory {
namespace {

double field_at(const CrownField& field, glm::dvec3 p, glm::dvec3 n) {
  return reference::crown_field(field.grid, field.cells, p, glm::normalize(n));
}

Prototype prototype_of(std::vector<glm::vec3> positions, std::vector<std::uint32_t> triangles) {
  RawMesh mesh;
  mesh.parts.push_back({"part", "leaf", SurfaceClass::leaf, std::move(positions), std::move(triangles)});
  return rigid_prototype("shape", mesh);
}

Prototype box() {
  std::vector<glm::vec3> corners;
  for (int i = 0; i < 8; ++i) corners.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 4 : 2);
  return prototype_of(corners, {0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5});
}

TEST(CrownFieldBake, ConvexBodySeesTheOpenSky) {
  // Every surface is seen and sees all that its tilt allows: (1 + cos)/2 under the dome, 1 under the sphere. The
  // insides are not seen and have no say.
  CrownFieldOptions options;
  options.cells = 2;
  const CrownField dome = bake_crown_field(box(), options);
  options.sky = Sky::sphere;
  const CrownField sphere = bake_crown_field(box(), options);
  const glm::dvec3 middle(0, 0, 3);
  for (const glm::dvec3 n : {glm::dvec3(0, 0, 1), glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0)}) {
    EXPECT_NEAR(field_at(dome, middle + n, n), (1 + n.z) / 2, 0.03);
    EXPECT_NEAR(field_at(sphere, middle + n, n), 1, 0.03);
  }
  EXPECT_NEAR(field_at(dome, middle - glm::dvec3(0, 0, 1), {0, 0, -1}), 0, 0.03);
}

TEST(CrownFieldBake, ShrubIsNearTheTruthOfWhatIsSeen) {
  const SpeciesSource source = small_species("shrub", 3000);
  const Prototype shrub = build_species(source, 4, nullptr).prototype;
  const RestSurface surface(shrub);
  const SeenSurface seen = seen_surface(surface, shrub, 6000);
  for (const Sky sky : {Sky::dome, Sky::sphere}) {
    TruthOptions truth_options;
    truth_options.sky = sky;
    const Truth truth = trace_truth(surface.tracer(), seen.positions, seen.normals, truth_options);
    CrownFieldOptions options;
    options.sky = sky;
    const CrownField field = bake_crown_field(shrub, options);
    double mean = 0, spread = 0, error = 0, bias = 0;
    const auto count = static_cast<double>(seen.positions.size());
    for (const float v : truth.visibility) mean += double(v) / count;
    for (std::size_t i = 0; i < seen.positions.size(); ++i) {
      const double exact = double(truth.visibility[i]);
      const double difference = field_at(field, glm::dvec3(seen.positions[i]), glm::dvec3(seen.normals[i])) - exact;
      spread += (exact - mean) * (exact - mean) / count;
      error += difference * difference / count;
      bias += difference / count;
    }
    EXPECT_LE(std::sqrt(error), 0.6 * std::sqrt(spread));
    EXPECT_NEAR(bias, 0, 0.015);
  }
}

TEST(CrownFieldBake, GivesTheSameBytesOnOneThread) {
  const Prototype shrub = build_species(small_species("shrub", 500), 4, nullptr).prototype;
  CrownFieldOptions options;
  options.least_rays = 2e5;
  const CrownField many = bake_crown_field(shrub, options);
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(bake_crown_field(shrub, options).cells, many.cells);
  options.seed = 2;
  EXPECT_NE(bake_crown_field(shrub, options).cells, many.cells);
}

}  // namespace
}  // namespace understory
