// Every implementation around the core that is compiled once for each scalar.
#pragma once

#include "instances/tools/instances.hpp"
//
#include "app/run_impl.hpp"
#include "report/result_table_impl.hpp"
