// A foreign G-buffer against its renderer's own ambient occlusion, for the obscurance table.
#pragma once
#include <filesystem>

#include "host/opencl/device.hpp"

namespace understory {

/// Prints RMSE and bias of many settings on gbuffer/gbuffer_walnut_meadow.exr of `data` against its Cycles AO pass (256
/// cosine-weighted rays, 3 m).
void print_gbuffer(Device& device, const std::filesystem::path& data);

}  // namespace understory
