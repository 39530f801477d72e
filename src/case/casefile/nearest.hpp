// What a mistyped word was meant to be.
#pragma once

#include <string>
#include <vector>

namespace edmill::casefile {

/// The candidate that a mistyped word most likely stands for: with few edits besides case, hyphens and
/// underscores, or one that it begins with or that begins with it. Empty when there is none.
std::string nearest(const std::string& word, const std::vector<std::string>& candidates);

/// "'height', or another of: a, b", with the nearest of the candidates first where there is one: "one of: a,
/// b".
std::string nearest_of(const std::string& word, const std::vector<std::string>& candidates);

}  // namespace edmill::casefile
