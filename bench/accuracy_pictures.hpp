// Truth, method and difference side by side, like figures 2 and 3 of Hegeman et al. 2006.
#pragma once
#include <filesystem>
#include <string>

#include "sim/frame.hpp"

namespace understory {

/// Writes `folder`/`name`.png, spaces as underscores: truth | method | method - truth in [-0.5, 0.5], blue: too dark.
/// `title`: over the method's part.
void write_accuracy_picture(const std::filesystem::path& folder, const std::string& name, const std::string& title,
                            const Frame& truth, const Frame& method);

}  // namespace understory
