#include "casefile/nearest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace edmill::casefile {

namespace {

/// The word in lower case, without hyphens and underscores.
std::string plain(const std::string& word) {
  std::string text;
  for (const char c : word)
    if (c != '-' && c != '_')
      text += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  return text;
}

/// Number of insertions, deletions, replacements and swaps of neighbours between two words.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<std::size_t>> to(a.size() + 1, std::vector<std::size_t>(b.size() + 1));
  for (std::size_t i = 0; i <= a.size(); ++i)
    for (std::size_t j = 0; j <= b.size(); ++j) {
      if (i == 0 || j == 0) {
        to[i][j] = i + j;
        continue;
      }
      const bool same = a[i - 1] == b[j - 1];
      to[i][j] = std::min({to[i - 1][j] + 1, to[i][j - 1] + 1, to[i - 1][j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        to[i][j] = std::min(to[i][j], to[i - 2][j - 2] + 1);
    }
  return to[a.size()][b.size()];
}

/// Whether a word begins with another one of at least three letters.
bool begins(const std::string& word, const std::string& with) {
  return with.size() >= 3 && word.starts_with(with);
}

}  // namespace

std::string nearest(const std::string& word, const std::vector<std::string>& candidates) {
  const std::string given = plain(word);
  std::string best;
  std::size_t fewest = 0;
  for (const auto& candidate : candidates) {
    const std::string known = plain(candidate);
    // A third of the letters may be wrong: otherwise short words would match any others.
    const std::size_t edits = edit_distance(given, known),
                      most = (std::max(given.size(), known.size()) + 1) / 3;
    const bool near = edits <= most || begins(known, given) || begins(given, known);
    if (!near || (!best.empty() && edits >= fewest)) continue;
    best = candidate;
    fewest = edits;
  }
  return best;
}

std::string nearest_of(const std::string& word, const std::vector<std::string>& candidates) {
  const auto list = fmt::format("{}", fmt::join(candidates, ", "));
  const auto best = nearest(word, candidates);
  return best.empty() ? "one of: " + list : "'" + best + "', or another of: " + list;
}

}  // namespace edmill::casefile
