// Case files: whatever the text, one clear error or a case whose balls find their places.
#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/study_spec.hpp"
#include "input.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  const std::string text(fuzz::text_of(data, size));
  try {
    const auto spec = casefile::parse_case(text, "case.toml", {});
    if (spec.ball_count() <= 50) casefile::build_case<double>(spec);
  } catch (const InputError&) {
  }
  return 0;
}
