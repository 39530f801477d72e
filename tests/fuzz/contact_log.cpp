// Logs of contacts, as `audit`, `compare` and `limit` read them.
#include "base/errors.hpp"
#include "dem/contacts.hpp"
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
