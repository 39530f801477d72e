// The declarations of run/sensitivity.hpp that the command needs, for builds without MPFR.
#pragma once

#include "app/certify.hpp"

namespace edmill::run {

struct SensitivityOptions : app::Options {
  std::vector<std::string> by;
  std::size_t events = 0;
  unsigned digits = 17;
  bool states = false;
};
struct Sensitivities : app::Evidence {
  std::vector<int> events;
};
Sensitivities sensitivity(const casefile::CaseSpec& spec, const SensitivityOptions& options);

}  // namespace edmill::run
