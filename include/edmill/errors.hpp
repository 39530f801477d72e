// Errors that edmill throws.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace edmill {

/// Base class of the errors that edmill finds; failures of files are `std::runtime_error`s.
class Error : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Invalid input that the user can correct. It contains all problems of a file together, each with
/// file, line, key, the value found and the values expected. The program exits with 2.
class InputError : public Error {
 public:
  explicit InputError(std::vector<std::string> problems)
      : Error(joined(problems)), problems_(std::move(problems)) {}
  explicit InputError(std::string problem)
      : InputError(std::vector<std::string>{std::move(problem)}) {}

  const std::vector<std::string>& problems() const { return problems_; }
 private:
  static std::string joined(const std::vector<std::string>& problems) {
    std::string text;
    for (const auto& problem : problems) text += (text.empty() ? "" : "\n") + problem;
    return text;
  }
  std::vector<std::string> problems_;
};

/// A decision that not even the widest scalar could make; the message contains the state that
/// reproduces it.
class UndecidedError : public Error {
 public:
  using Error::Error;
};

/// The user ended the program before there were any results.
class InterruptedError : public Error {
 public:
  InterruptedError() : Error("interrupted before the first event; there are no results") {}
};

/// A broken precondition inside edmill.
class ContractError : public Error {
 public:
  using Error::Error;
};

}  // namespace edmill
