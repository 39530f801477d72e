// The engine and the searches, compiled once for each scalar; for the instantiation files only.
#pragma once

#include "base/wide_trigonometry.hpp"
#include "dynamics/decision_ladder_impl.hpp"
#include "dynamics/wall_search_impl.hpp"
#include "engine/simulation_impl.hpp"

/// `prefix` is `extern template` to declare and `template` to define.
#define EDMILL_GENERAL_SEARCH(prefix, Real)                                   \
  prefix class edmill::dynamics::WallSearch<edmill::model::AnyMotion<Real>,   \
      edmill::model::AnyVessel<Real>>;                                        \
  prefix class edmill::dynamics::WallSearch<edmill::model::ChainMotion<Real>, \
      edmill::model::RoundedBody<Real>>;                                      \
  prefix class edmill::dynamics::AnyWallSearch<Real>;
#define EDMILL_LADDER(prefix, Real) \
  EDMILL_GENERAL_SEARCH(prefix, Real) prefix class edmill::dynamics::DecisionLadder<Real>;

// The wider rungs of a ladder are in files of their own.
EDMILL_LADDER(extern template, edmill::float128)
EDMILL_LADDER(extern template, edmill::mpfr50)
#if !defined(EDMILL_WITHOUT_MPFR)
EDMILL_LADDER(extern template, edmill::mpfr)
#endif
