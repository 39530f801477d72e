// A progress line for long work, on a terminal only.
#pragma once

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "io/terminal.hpp"

namespace edmill::io {

/// The progress line on standard error; the destructor removes it.
class ProgressLine {
 public:
  /// @param quiet  true to show nothing
  explicit ProgressLine(bool quiet) : shows_(!quiet && ::isatty(STDERR_FILENO)) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// Whether it is shown at all: standard error is a terminal, and nobody asked for quiet.
  explicit operator bool() const { return shows_; }
  void show(const std::string& text) {
    if (!shows_) return;
    tell("{}{}", no_line, text);
    visible_ = true;
  }
  /// As in run::Progress; the dose since this line was made.
  void show(double now, const std::optional<double>& end, std::uint64_t collisions,
      const std::optional<double>& milling_dose = std::nullopt) {
    const auto time = Clock::now();
    if (!first_) first_ = Look{time, now, collisions};
    if (time - shown_ < std::chrono::milliseconds(200)) return;
    shown_ = time;
    const double spent = std::chrono::duration<double>(time - first_->time).count();
    const double simulated = now - first_->now;
    std::string line = fmt::format("{:.3f} s", now);
    if (end) line += fmt::format(" of {:g} s", *end);
    line += fmt::format(" simulated, {} collisions", collisions);
    if (spent > 0)
      line +=
          fmt::format(", {:.3g}/s", static_cast<double>(collisions - first_->collisions) / spent);
    if (milling_dose && simulated > 0) line += fmt::format(", {:.3g} W", *milling_dose / simulated);
    if (end && simulated > 0) {
      const double left = spent * (*end - now) / simulated;
      line += fmt::format(
          ", {}:{:02} left", static_cast<long>(left) / 60, static_cast<long>(left) % 60);
    }
    show(line);
  }
  /// Removes the line.
  void clear() {
    if (visible_) tell("{}", no_line);
    visible_ = false;
  }
 private:
  static constexpr const char* no_line = "\r\x1b[K";
  using Clock = std::chrono::steady_clock;
  struct Look {
    Clock::time_point time;
    double now;
    std::uint64_t collisions;
  };
  bool shows_, visible_ = false;
  std::optional<Look> first_;  ///< the first call; a resumed run has begun before
  Clock::time_point shown_ = Clock::now();
};

}  // namespace edmill::io
