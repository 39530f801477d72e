// A case that is checked as a run would check it, in SI with its derived numbers.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::app {

struct CheckedCase {
  std::string file;
  /// Names and values; an empty name continues the entry before.
  std::vector<std::pair<std::string, std::string>> facts;

  std::string text() const;
};

/// @throws InputError when its balls do not fit
/// @throws UndecidedError when no scalar can decide about a first contact
CheckedCase check(const casefile::CaseSpec& spec);

/// An SVG of how the vessel moves. @throws InputError when the file cannot be written
void draw_mill(const casefile::CaseSpec& spec, const std::filesystem::path& file);

}  // namespace edmill::app
