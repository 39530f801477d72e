// Numbers with units.
#include "casefile/quantity.hpp"

#include "base/errors.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  if (size == 0) return 0;
  const auto text = fuzz::text_of(data + 1, size - 1);
  const auto dimension =
      static_cast<Dimension>(data[0] % (static_cast<int>(Dimension::pressure) + 1));
  casefile::parse_quantity(text, dimension);
  casefile::parse_quantity(text, dimension, casefile::SizeLimit::physical, casefile::Plain::is_si);
  casefile::parse_decimal(text);
  return 0;
}
