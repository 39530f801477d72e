// What a case file and a reader need to know of a contact law's parameter.
#pragma once

#include <optional>

namespace edmill::model {

/// A number without unit in [low, high].
struct LawParameter {
  const char* key;
  int low, high;
  std::optional<int> fallback = std::nullopt;  ///< of a parameter that may be left out
};

}  // namespace edmill::model
