// Decisions that one scalar could not make.
#pragma once

#include <cstdint>
#include <string>

#include "base/archive.hpp"

namespace edmill {

/// Decisions that were passed up to one wider scalar.
struct Escalations {
  std::string scalar;
  std::uint64_t wall = 0;
  std::uint64_t pair = 0;
  std::uint64_t order = 0;  ///< which of two contacts of one ball comes first

  void archive(Archive& a) { a(scalar, wall, pair, order); }
};

}  // namespace edmill
