// The owner table as JSON, for the header of frame files: [{"class", "species", "instance", "albedo", "crown",
// "group"}].
#pragma once
#include <string>
#include <vector>

#include "sim/world.hpp"

namespace understory {

std::string owners_to_json(const std::vector<Owner>& owners);

/// Throws Error(invalid_input) naming the row and what is wrong with it.
std::vector<Owner> owners_from_json(const std::string& text);

}  // namespace understory
