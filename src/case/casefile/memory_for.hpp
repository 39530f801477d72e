// Lack of memory as an error message that names the case.
#pragma once

#include <new>
#include <stdexcept>
#include <string>

#include "casefile/case_spec.hpp"

namespace edmill::casefile {

class OutOfMemory : public std::bad_alloc {
 public:
  explicit OutOfMemory(const CaseSpec& spec)
      : text_(spec.file + ": not enough memory for " + std::to_string(spec.ball_count()) +
              " balls: use fewer balls, or a computer with more memory") {}
  const char* what() const noexcept override { return text_.c_str(); }

 private:
  std::string text_;
};

/// Calls work() and returns its result. @throws OutOfMemory when there is too little memory
auto with_memory_for(const CaseSpec& spec, const auto& work) try {
  return work();
} catch (const std::bad_alloc&) {
  throw OutOfMemory(spec);
} catch (const std::length_error&) {
  throw OutOfMemory(spec);
}

}  // namespace edmill::casefile
