// Every implementation that is compiled once for each scalar.
#pragma once

#include "instances/instances.hpp"
//
#include "base/scalar_text.hpp"
#include "casefile/build_case_impl.hpp"
#include "cli/run_case_impl.hpp"
#include "dynamics/decision_ladder_impl.hpp"
#include "dynamics/wall_search_impl.hpp"
#include "engine/simulation_impl.hpp"
#include "io/final_state_impl.hpp"
#include "io/summary_impl.hpp"
#include "report/result_table_impl.hpp"
#include "run/event_source_impl.hpp"
#include "run/simulate_impl.hpp"
