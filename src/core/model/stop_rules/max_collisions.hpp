// A number of impacts.
#pragma once

#include "base/archive.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

struct MaxCollisions {
  static constexpr Parameter key{"max_collisions", Dimension::none, "the run ends after this many impacts",
                                 Range::count};

  template <class Real>
  struct Watch {
    Real limit;

    bool is_met(const auto& impact, const auto&) const { return Real(impact.index + 1) >= limit; }
    void archive(Archive&) {}
  };
};

}  // namespace edmill::model
