// Lists of contacts with walls, as `import` reads them.
#include "base/errors.hpp"
#include "dem/contacts.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const auto file = fuzz::file_of(fuzz::text_of(data, size), "collisions.csv");
  try {
    dem::is_contact_list(file);
    dem::read_contact_list(file);
  } catch (const InputError&) {
  }
  return 0;
}
