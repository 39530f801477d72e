// Certificates, as their checker reads them. To random input a wrong number is more likely than a
// right one, so that the checker is called with few events.
#include <cstdint>
#include <sstream>

#include "check.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  std::istringstream in(std::string(reinterpret_cast<const char*>(data), size));
  try {
    checker::check(in);
  } catch (const std::exception&) {
  }
  return 0;
}
