// Logs of contacts, as `audit`, `compare` and `limit` read them.
#include "dem/contact_log.hpp"

#include "base/errors.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const auto file = fuzz::file_of(fuzz::text_of(data, size), "contacts.csv");
  try {
    dem::is_contact_log(file);
    dem::ContactLogReader reader(file);
    while (reader.next()) {
    }
  } catch (const InputError&) {
  }
  return 0;
}
