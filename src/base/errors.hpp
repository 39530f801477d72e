// Errors that edmill throws, and always-armed contract checks.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace edmill {

/// Input that a user can mend; the application reports it and exits with 2.
class InputError : public std::runtime_error {
 public:
  explicit InputError(std::vector<std::string> problems)
      : std::runtime_error(joined(problems)), problems_(std::move(problems)) {}
  explicit InputError(std::string problem) : InputError(std::vector<std::string>{std::move(problem)}) {}

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  static std::string joined(const std::vector<std::string>& problems) {
    std::string text;
    for (const auto& problem : problems) text += (text.empty() ? "" : "\n") + problem;
    return text;
  }
  std::vector<std::string> problems_;
};

/// A decision that the widest scalar could not make; the text holds the state that reproduces it.
class UndecidedError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The user ended the program before there was anything to keep.
class InterruptedError : public std::runtime_error {
 public:
  InterruptedError() : std::runtime_error("interrupted before the first event; there are no results") {}
};

/// A broken precondition inside the program.
class ContractError : public std::logic_error {
 public:
  using std::logic_error::logic_error;
};

}  // namespace edmill

#define EDMILL_STRINGIFY_(x) #x
#define EDMILL_STRINGIFY(x) EDMILL_STRINGIFY_(x)
/// Always armed: throws ContractError with file, line and the broken condition.
#define EDMILL_REQUIRE(condition, message)                                                        \
  do {                                                                                            \
    if (!(condition))                                                                             \
      throw ::edmill::ContractError(                                                              \
          std::string(__FILE__ ":" EDMILL_STRINGIFY(__LINE__) ": " #condition ": ") + (message)); \
  } while (false)
