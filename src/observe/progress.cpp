#include "edmill/observe/progress.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace edmill::observe {

ProgressLine::ProgressLine(double start, std::optional<double> end)
    : start_(start), end_(end), begun_(Clock::now()), shown_(begun_) {}

ProgressLine::~ProgressLine() {
  if (visible_) fmt::print(stderr, "\r\033[K");
}

void ProgressLine::show(double now, std::uint64_t collisions) {
  const auto time = Clock::now();
  if (time - shown_ < std::chrono::milliseconds(200)) return;
  shown_ = time;
  const double spent = std::chrono::duration<double>(time - begun_).count();
  std::string line = fmt::format("{:.3f} s", now);
  if (end_) line += fmt::format(" of {:g} s", *end_);
  line +=
      fmt::format(" simulated, {} collisions, {:.3g}/s", collisions, static_cast<double>(collisions) / spent);
  if (end_ && now > start_) {
    const double left = spent * (*end_ - now) / (now - start_);
    line += fmt::format(", {}:{:02} left", static_cast<long>(left) / 60, static_cast<long>(left) % 60);
  }
  fmt::print(stderr, "\r\033[K{}", line);
  std::fflush(stderr);
  visible_ = true;
}

}  // namespace edmill::observe
