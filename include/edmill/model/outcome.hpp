// Plain values that describe how a run went.
#pragma once

#include "edmill/core/archive.hpp"

namespace edmill::model {

/// Mechanical energy of all balls [J].
template <class Real>
struct Energy {
  Real kinetic{0};    ///< translation and spin
  Real potential{0};  ///< -m g.r

  void archive(Archive& a) { a(kinetic, potential); }
};

/// Where a run could not go on: the exact model has a Zeno point here. (docs/theory.md, section 6)
template <class Real>
struct InelasticCollapse {
  int ball = -1;
  bool with_wall = false;
  int partner = -1;
  Real accumulation_time{};  ///< when the impacts accumulate [s]
};

}  // namespace edmill::model
