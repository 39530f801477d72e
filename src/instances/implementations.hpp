// Every implementation that is compiled once for each scalar.
#pragma once

#include "edmill/instances.hpp"
//
#include "edmill/app/run_case_impl.hpp"
#include "edmill/certify/event_source_impl.hpp"
#include "edmill/core/scalar_text.hpp"
#include "edmill/driver/simulate_impl.hpp"
#include "edmill/dynamics/decision_ladder_impl.hpp"
#include "edmill/dynamics/wall_search_impl.hpp"
#include "edmill/engine/simulation_impl.hpp"
#include "edmill/record/final_state_impl.hpp"
#include "edmill/record/summary_impl.hpp"
#include "edmill/report/result_table_impl.hpp"
#include "edmill/setup/build_case_impl.hpp"
