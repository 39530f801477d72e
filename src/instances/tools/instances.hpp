// What is around the core in every scalar: what is compiled once, declared.
#pragma once

#include "instances/instances.hpp"
//
#include "app/run.hpp"
#include "report/result_table.hpp"

/// `prefix` is `extern template` to declare and `template` to define.
#define EDMILL_TOOL_INSTANCES(prefix, Real)                                                  \
  namespace edmill {                                                                         \
  prefix std::string report::result_table<Real>(const io::Summary<Real>&);                   \
  prefix app::RunResult app::run_in<Real>(const casefile::CaseSpec&, const app::RunOptions&, \
                                          const std::function<std::filesystem::path()>&);    \
  }

#define EDMILL_DECLARE_INSTANCES(Real) EDMILL_TOOL_INSTANCES(extern template, Real)
EDMILL_FOR_EACH_SCALAR(EDMILL_DECLARE_INSTANCES)
#undef EDMILL_DECLARE_INSTANCES
