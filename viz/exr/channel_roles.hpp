// Which channels of somebody else's EXR hold what: found by the names that renderers use, never guessed between two.
// Blender, Arnold, pbrt, Mitsuba, OSPRay, V-Ray, RenderMan, Houdini and Nuke differ in layer, suffix and letter case.
#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace understory {

/// The channels of one quantity, in order x, y, z for vectors or alone for scalars.
struct RoleChannels {
  std::vector<std::string> names;
};

/// What a G-buffer may hold; without a normal its names are empty. `depth` and `alpha` only mark the background;
/// `owner` is never found by itself.
struct ChannelRoles {
  RoleChannels position, normal;
  std::optional<RoleChannels> depth, alpha, owner;
  std::vector<std::string> notes;  // what was left alone and why
};

/// Explicit choices win: role (position, normal, depth, alpha, owner) to layer or channel, in the file's own letters,
/// for instance {"normal", "Ns"}. Throws Error(usage) for an unknown role or a name that is not in the file, and
/// Error(invalid_input) when nothing or more than one thing fits; the message lists what there is. Normal,
/// depth and alpha may be missing; depth and alpha are left alone when several fit.
ChannelRoles resolve_channel_roles(const std::vector<std::string>& channels,
                                   const std::map<std::string, std::string>& chosen);

/// "position=Ns,normal=N" to a map. Throws Error(usage).
std::map<std::string, std::string> parse_channel_choices(const std::string& text);

}  // namespace understory
