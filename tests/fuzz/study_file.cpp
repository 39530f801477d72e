// Files of sweeps and optimisations.
#include "base/errors.hpp"
#include "casefile/study_spec.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const auto file = fuzz::file_of(fuzz::text_of(data, size), "study.toml");
  try {
    casefile::read_sweep(file.string());
  } catch (const InputError&) {
  }
  try {
    casefile::read_optimize(file.string());
  } catch (const InputError&) {
  }
  return 0;
}
