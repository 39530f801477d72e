// Every implementation of the core that is compiled once for each scalar.
#pragma once

#include "instances/instances.hpp"
//
#include "api/run_impl.hpp"
#include "casefile/build_case_impl.hpp"
#include "dynamics/decision_ladder_impl.hpp"
#include "dynamics/wall_search_impl.hpp"
#include "engine/simulation_impl.hpp"
#include "io/final_state_impl.hpp"
#include "io/summary_impl.hpp"
#include "output/outputs_impl.hpp"
#include "run/event_source_impl.hpp"
#include "run/simulate_impl.hpp"
