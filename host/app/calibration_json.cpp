#include "host/app/calibration_json.hpp"

namespace understory {
namespace {

nlohmann::json numbers(const glm::vec3& v) { return {v.x, v.y, v.z}; }

const char* name_of(CrownShape shape) {
  switch (shape) {
    case CrownShape::sphere:
      return "sphere";
    case CrownShape::ellipsoid:
      return "ellipsoid";
    case CrownShape::shells:
      return "shells";
  }
  return "";
}

nlohmann::ordered_json shells_json(const CrownShell& crown, const CrownModel& model) {
  nlohmann::ordered_json shells = nlohmann::json::array();
  shells.push_back({{"shape", "sphere"},
                    {"centre_m", numbers(crown.sphere_centre)},
                    {"radius_m", crown.sphere_radius},
                    {"opacity", model.opacity}});
  shells.push_back(
      {{"shape", "ellipsoid"},
       {"centre_m", numbers(crown.ellipsoid_centre)},
       {"radii_m", numbers(crown.ellipsoid_radii)},
       {"axes",
        {numbers(crown.ellipsoid_axes[0]), numbers(crown.ellipsoid_axes[1]), numbers(crown.ellipsoid_axes[2])}}});
  for (std::size_t i = 0; i < crown.shells.size(); ++i)
    shells.push_back({{"shape", "cluster"},
                      {"centre_m", numbers(glm::vec3(crown.shells[i]))},
                      {"radius_m", crown.shells[i].w},
                      {"opacity", i < model.shell_opacity.size() ? model.shell_opacity[i] : 0.0f}});
  return shells;
}

}  // namespace

nlohmann::ordered_json calibration_json(const Prototype& prototype, const Calibration& calibration) {
  const CrownModel& model = calibration.model;
  nlohmann::ordered_json transmittance = nlohmann::json::object();
  for (const auto& [shape, constants] : calibration.transmittance)
    transmittance[shape] = {{"k_per_m", constants[0]}, {"near_share", constants[1]}, {"shell_scale", constants[2]}};
  const DensityGrid& grid = calibration.density;
  return {{"name", prototype.name},
          {"triangles", prototype.triangle_count()},
          {"leaf_area_m2", calibration.leaf_area},
          {"plant_area_m2", calibration.plant_area},
          {"lad_mean", calibration.lad_mean},
          {"pad_mean", calibration.pad_mean},
          {"k", calibration.k},
          {"clumping", calibration.clumping},
          {"open_share_error_heldout", calibration.open_error},
          {"alpha_rho", model.alpha_rho},
          {"alpha_rho_ellipsoid", model.alpha_rho_ellipsoid},
          {"alpha_rho_shells", model.alpha_rho_shells},
          {"alpha_rho_levels", model.alpha_rho_levels},
          {"reeves_blau", {{"ambient", model.reeves_blau_ambient}, {"extinction", model.reeves_blau_extinction}}},
          {"ambient", calibration.ambient},
          {"crown_transmittance", transmittance},
          {"best_shape", name_of(model.shape)},
          {"shells", shells_json(prototype.crown, model)},
          {"points", calibration.points},
          {"rmse_heldout", calibration.rmse_heldout},
          {"density_grid",
           {{"low_m", numbers(grid.low)},
            {"high_m", numbers(grid.high)},
            {"cells", {grid.cells.x, grid.cells.y, grid.cells.z}},
            {"plant_area_density", grid.density}}}};
}

}  // namespace understory
