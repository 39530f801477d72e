// The declarations of run/sensitivity.hpp that the command needs, for builds without MPFR.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"

namespace edmill::run {

struct SensitivityOptions {
  std::vector<std::string> by;
  std::size_t events = 0;
  unsigned digits = 17;
  bool states = false;
  std::string file;
  const std::atomic<bool>* interrupt = nullptr;
  std::function<void(const std::string& precision, std::size_t events)> progress;
};
struct Sensitivities {
  std::vector<int> events;
  std::string precision;
  bool interrupted = false;
};
Sensitivities sensitivity(const casefile::CaseSpec& spec, const SensitivityOptions& options);

}  // namespace edmill::run
