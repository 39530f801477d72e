// Dumps and decks of DEM codes, as `import` reads them.
#include "base/errors.hpp"
#include "dem/contacts.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const auto file = fuzz::file_of(fuzz::text_of(data, size), "frames.dump");
  try {
    dem::facts_of_deck(file);
    dem::FrameReader reader(file, {1e-6, "si"}, 2);
    for (dem::Frame frame; reader.next(frame);) {
    }
  } catch (const InputError&) {
  }
  return 0;
}
