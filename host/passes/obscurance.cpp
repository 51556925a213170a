#include "host/passes/obscurance.hpp"

#include <algorithm>
#include <cmath>

#include "sim/error.hpp"

namespace understory {
namespace {

void store(float (&to)[4], glm::vec3 from) {
  for (int i = 0; i < 3; ++i) to[i] = from[i];
  to[3] = 0;
}

float share_of(const ObscuranceSample& sample, const NearField& near_field) {
  return near_field.falloff == "quadratic" ? sample.quadratic_share : sample.constant_share;
}

void require_positive(const char* what, double value) {
  if (std::isfinite(value) && value > 0) return;
  throw Error(ErrorKind::invalid_input,
              std::string("obscurance: ") + what + " " + std::to_string(value) + "; allowed: a number above 0");
}

}  // namespace

ObscuranceSetting obscurance_setting(const ObscuranceView& view, const NearField& near_field) {
  require_positive("radius", near_field.radius);
  require_positive("focal length", view.focal);
  ObscuranceSetting setting{};
  store(setting.right, view.right);
  store(setting.down, view.down);
  store(setting.forward, view.forward);
  setting.focal = static_cast<float>(view.focal);
  setting.centre_x = static_cast<float>(view.centre_x);
  setting.centre_y = static_cast<float>(view.centre_y);
  setting.perspective = view.perspective ? 1.0f : 0.0f;
  setting.width = view.width;
  setting.height = view.height;
  setting.radius = static_cast<float>(near_field.radius);
  setting.second_radius = static_cast<float>(near_field.second_radius);
  setting.thickness = static_cast<float>(near_field.thickness);
  return setting;
}

bool is_cosine(const NearField& near_field) { return near_field.falloff == "cosine" && near_field.normals != "none"; }

std::string obscurance_options(const NearField& near_field) {
  std::string options;
  if (near_field.normals != "none") options += " -DNORMALS";
  if (near_field.falloff == "quadratic") options += " -DQUADRATIC";
  if (is_cosine(near_field)) options += " -DCOSINE";
  if (near_field.thickness > 0) options += " -DTHICKNESS";
  if (near_field.second_radius > 0) options += near_field.radii == "minimum" ? " -DRADII=2" : " -DRADII=1";
  return options;
}

std::vector<ObscuranceRow> line_rows(const ObscuranceSampleSet& set, const NearField& near_field) {
  const bool quadratic = near_field.falloff == "quadratic";
  const double size = is_cosine(near_field) ? 0.5 : 1;
  std::vector<ObscuranceRow> rows;
  for (const ObscuranceSample& sample : set.samples) {
    const double x = size * double{sample.x}, y = size * double{sample.y},
                 half = std::sqrt(size * size - x * x - y * y);
    const double whole = quadratic ? 4.0 / 3 * half * half * half : 2 * half;
    rows.push_back({static_cast<float>(x), static_cast<float>(y), static_cast<float>(half),
                    static_cast<float>(double{share_of(sample, near_field)} / whole)});
  }
  return rows;
}

std::vector<ObscuranceRow> point_rows(const ObscuranceSampleSet& set, const NearField& near_field) {
  const float size = is_cosine(near_field) ? 0.5f : 1.0f;
  std::vector<ObscuranceRow> rows;
  for (const ObscuranceSample& sample : set.samples)
    rows.push_back({size * sample.x, size * sample.y, size * sample.z, share_of(sample, near_field)});
  return rows;
}

void require_view(const char* pass, const FragmentPlanes& planes, const ObscuranceView& view,
                  const Buffer<float>& visibility) {
  require_planes(pass, planes, visibility);
  require_size(pass, "depth", planes.depth.size(), planes.padded_fragments);
  const std::size_t pixels = static_cast<std::size_t>(view.width) * static_cast<std::size_t>(view.height);
  require_size(pass, "image", pixels, planes.fragments);
}

}  // namespace understory
