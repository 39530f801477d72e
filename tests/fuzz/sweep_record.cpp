// Records of the runs of a study.
#include <cstring>

#include "base/version.hpp"
#include "input.hpp"
#include "study/run_record.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace edmill;
  // Only records of this program are read further.
  std::string text(fuzz::text_of(data, size));
  for (const auto& [word, own] : {std::pair{"VERSION", version()}, std::pair{"COMMIT", commit()}})
    if (const auto at = text.find(word); at != std::string::npos)
      text.replace(at, std::strlen(word), own);
  if (const auto record = study::from_json(text))
    for (const auto& quantity : study::quantities(3)) quantity.of(*record);
  return 0;
}
