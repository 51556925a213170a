// Names are split at the last dot into layer and component; the last element of the layer decides, without case,
// blanks and underscores ("__Pworld", "View Layer.Position", "worldPosition").
#include "viz/exr/channel_roles.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "sim/error.hpp"

namespace understory {
namespace {

struct Role {
  const char* name;
  std::vector<std::string> layers;                   // normalised last layer elements; "" is the root
  std::vector<std::vector<std::string>> components;  // per axis: normalised accepted suffixes
};

const std::vector<std::string> first_axis{"x", "r", "[red]"}, second_axis{"y", "g", "[green]"},
    third_axis{"z", "b", "[blue]"};

const Role& find_role(const std::string& name) {
  static const std::vector<Role> roles{
      {"position",
       {"position", "p", "pos", "pworld", "pw", "worldposition", "positionworld", "worldpoint", "pointworld"},
       {first_axis, second_axis, third_axis}},
      {"normal",
       {"normal", "normals", "n", "ns", "nn", "ng", "nworld", "worldnormal", "normalworld", "shnormal", "geonormal",
        "shadingnormal"},
       {first_axis, second_axis, third_axis}},
      {"depth", {"depth", "z", "zdepth", "distance", ""}, {{"z", "v", "t", "depth"}}},
      {"alpha", {"", "combined", "rgba", "beauty"}, {{"a", "alpha"}}},
      {"owner", {}, {{"x", "y", "i", "v", "r", "z"}}},
  };
  const auto at = std::find_if(roles.begin(), roles.end(), [&](const Role& role) { return name == role.name; });
  if (at == roles.end())
    throw Error(ErrorKind::usage,
                fmt::format("no role `{}` for channels; there are position, normal, depth, alpha, owner", name));
  return *at;
}

std::string normalised(const std::string& text) {
  std::string result;
  for (const char c : text)
    if (c != '_' && c != ' ' && c != '-') result += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return result;
}

std::string layer_of(const std::string& channel) {
  const auto dot = channel.rfind('.');
  return dot == std::string::npos ? "" : channel.substr(0, dot);
}

std::string component_of(const std::string& channel) {
  const auto dot = channel.rfind('.');
  return dot == std::string::npos ? channel.substr(channel.rfind(':') + 1) : channel.substr(dot + 1);
}

std::string last_element(const std::string& layer) {
  const auto separator = layer.find_last_of(".:");
  return separator == std::string::npos ? layer : layer.substr(separator + 1);
}

bool contains(const std::vector<std::string>& list, const std::string& item) {
  return std::find(list.begin(), list.end(), item) != list.end();
}

/// One channel per component of the role, all in `layer`; empty when one is missing.
RoleChannels channels_in_layer(const std::vector<std::string>& channels, const std::string& layer, const Role& role) {
  RoleChannels result;
  for (const auto& suffixes : role.components) {
    const auto fits = [&](const std::string& c) {
      return layer_of(c) == layer && contains(suffixes, normalised(component_of(c)));
    };
    const auto at = std::find_if(channels.begin(), channels.end(), fits);
    if (at == channels.end()) return {};
    result.names.push_back(*at);
  }
  return result;
}

RoleChannels resolve_choice(const std::vector<std::string>& channels, const Role& role, const std::string& choice) {
  if (role.components.size() == 1 && contains(channels, choice)) return {{choice}};
  const RoleChannels found = channels_in_layer(channels, choice, role);
  if (found.names.empty())
    throw Error(ErrorKind::usage, fmt::format("{}={}: no such layer or channel with {} component(s); the file has {}",
                                              role.name, choice, role.components.size(), fmt::join(channels, ", ")));
  return found;
}

std::optional<RoleChannels> resolve(const std::vector<std::string>& channels, const std::string& name,
                                    const std::map<std::string, std::string>& chosen) {
  const Role& role = find_role(name);
  if (const auto choice = chosen.find(name); choice != chosen.end())
    return resolve_choice(channels, role, choice->second);
  std::vector<std::string> layers;
  std::vector<RoleChannels> candidates;
  for (const std::string& channel : channels) {
    const std::string layer = layer_of(channel);
    if (contains(layers, layer) || !contains(role.layers, normalised(last_element(layer)))) continue;
    layers.push_back(layer);
    if (const auto found = channels_in_layer(channels, layer, role); !found.names.empty()) candidates.push_back(found);
  }
  if (candidates.size() <= 1) return candidates.empty() ? std::nullopt : std::optional(candidates.front());
  std::vector<std::string> names;
  for (const auto& candidate : candidates) names.push_back(fmt::format("{}", fmt::join(candidate.names, "/")));
  throw Error(ErrorKind::invalid_input,
              fmt::format("{} could be {}; choose one, for instance {}={}", name, fmt::join(names, " or "), name,
                          layer_of(candidates.front().names.front())));
}

}  // namespace

ChannelRoles resolve_channel_roles(const std::vector<std::string>& channels,
                                   const std::map<std::string, std::string>& chosen) {
  for (const auto& [name, choice] : chosen) find_role(name);
  const auto need = [&](const std::string& name) {
    if (auto found = resolve(channels, name, chosen)) return *found;
    throw Error(ErrorKind::invalid_input,
                fmt::format("no {} channels found by name (such as {}); the file has {}; name them: {}=LAYER", name,
                            fmt::join(find_role(name).layers, ", "), fmt::join(channels, ", "), name));
  };
  ChannelRoles roles;
  roles.position = need("position");
  roles.normal = resolve(channels, "normal", chosen).value_or(RoleChannels{});
  const auto want = [&](const std::string& name) -> std::optional<RoleChannels> {
    try {
      return resolve(channels, name, chosen);
    } catch (const Error& error) {
      if (error.kind() == ErrorKind::usage) throw;
      roles.notes.push_back(std::string(error.what()) + "; none taken");
      return std::nullopt;
    }
  };
  roles.depth = want("depth");
  roles.alpha = want("alpha");
  roles.owner = resolve(channels, "owner", chosen);
  return roles;
}

std::map<std::string, std::string> parse_channel_choices(const std::string& text) {
  std::map<std::string, std::string> choices;
  std::stringstream items(text);
  for (std::string item; std::getline(items, item, ',');) {
    const auto equals = item.find('=');
    if (equals == std::string::npos || equals + 1 == item.size())
      throw Error(ErrorKind::usage, fmt::format("`{}`: channels are chosen by role=layer[,role=layer]", item));
    const std::string role = item.substr(0, equals);
    find_role(role);
    if (!choices.emplace(role, item.substr(equals + 1)).second)
      throw Error(ErrorKind::usage, fmt::format("`{}`: role {} chosen twice", text, role));
  }
  return choices;
}

}  // namespace understory
