// Suggestions for mistyped words.
#pragma once

#include <string>
#include <vector>

namespace edmill::casefile {

/// The candidate that was most likely meant by a mistyped word: one that needs few edits besides case,
/// hyphens and underscores, or one of which the word is a prefix or that is a prefix of the word. Empty
/// without any.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// The candidates as text, the nearest one first: "'height', or another of: a, b"; "one of: a, b" if none is
/// near.
std::string nearest_of(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace edmill::casefile
