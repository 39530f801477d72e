// Collision logs of other codes, as `compare` and `audit` read them.
#include "audit/event_log.hpp"
#include "base/errors.hpp"
#include "compare/log_reader.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const auto file = fuzz::file_of(fuzz::text_of(data, size), "collisions.csv");
  try {
    compare::scan_log(file);
  } catch (const InputError&) {
  }
  try {
    audit::EventLog log(file, {}, 5, 3, 1e15);
    while (log.next()) {
    }
  } catch (const InputError&) {
  }
  return 0;
}
