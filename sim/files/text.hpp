// Small helpers for names and messages that more than one reader needs.
#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace understory {

/// The candidate that a misspelt word most likely means: few edits apart; empty when none is near.
std::string closest_word(std::string_view word, const std::vector<std::string>& candidates);

/// Does a name match a pattern of `*` (any text) and `?` (any character)? Letter case does not matter.
bool matches_pattern(std::string_view name, std::string_view pattern);

/// Text from a file made fit for one line of a message: control characters replaced, cut after 60 bytes.
std::string readable(std::string_view text);

std::string join(const std::vector<std::string>& words, std::string_view separator);

}  // namespace understory
