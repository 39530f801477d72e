// Collision logs of other codes, as `compare` and `audit` read them.
#include "base/errors.hpp"
#include "input.hpp"
#include "logs/event_log.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const auto file = fuzz::file_of(fuzz::text_of(data, size), "collisions.csv");
  try {
    logs::scan_log(file);
  } catch (const InputError&) {
  }
  try {
    logs::EventLog log(file, {}, 5, 3, 1e15);
    while (log.next()) {
    }
  } catch (const InputError&) {
  }
  return 0;
}
