// What tests use of the core, in any scalar.
#pragma once

#include "base/scalar_list.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case.hpp"
#include "dynamics/decision_ladder.hpp"
#include "dynamics/wall_search.hpp"
#include "edmill/run.hpp"
#include "engine/simulation.hpp"
#include "io/final_state.hpp"
#include "io/summary.hpp"
#include "output/outputs.hpp"
#include "run/event_source.hpp"
