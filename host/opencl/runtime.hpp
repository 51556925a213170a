// What must happen once per process before the first OpenCL call that reads a device. For host/opencl only.
#pragma once
#include <filesystem>
#include <vector>

#include "host/opencl/opencl.hpp"

namespace understory {

/// Every device of every platform in the loader's order; empty when there is no platform. The first call sets up PoCL's
/// environment and repairs its cache.
std::vector<cl::Device> all_devices();

/// PoCL's cache folder of this process; empty without PoCL.
const std::filesystem::path& runtime_cache_folder();

}  // namespace understory
