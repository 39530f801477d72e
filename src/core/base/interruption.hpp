// Ends long computations of a thread early.
#pragma once

#include <atomic>

#include "edmill/errors.hpp"

namespace edmill {

/// While this lives, computations of the thread that call `check` end once its flag is true.
class Interruption {
 public:
  /// @param flag  null keeps the flag of the enclosing scope
  explicit Interruption(const std::atomic<bool>* flag) : before_(current()) {
    if (flag) current() = flag;
  }
  ~Interruption() { current() = before_; }
  Interruption(const Interruption&) = delete;
  Interruption& operator=(const Interruption&) = delete;

  /// @throws InterruptedError once the flag is true
  static void check() {
    if (const auto* flag = current(); flag && flag->load(std::memory_order_relaxed))
      throw InterruptedError();
  }
 private:
  static const std::atomic<bool>*& current() {
    static thread_local const std::atomic<bool>* flag = nullptr;
    return flag;
  }
  const std::atomic<bool>* before_;
};

}  // namespace edmill
