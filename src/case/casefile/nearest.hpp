// Suggestions for mistyped words.
#pragma once

#include <string>
#include <vector>

namespace edmill::casefile {

/// The candidate that was most likely meant by a mistyped word: one that needs few edits besides
/// case, hyphens and underscores, or of which one is a prefix of the other. Empty without any.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// The candidates as text, the nearest first: "'height', or another of: a, b"; or "one of: a, b".
std::string nearest_of(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace edmill::casefile
