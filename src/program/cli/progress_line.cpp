#include "cli/progress_line.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include "io/terminal.hpp"

namespace edmill::cli {

bool shows_progress(bool quiet) { return !quiet && ::isatty(STDERR_FILENO); }

ProgressLine::ProgressLine() : shown_(Clock::now()) {}

ProgressLine::~ProgressLine() {
  if (visible_) io::tell("{}", no_line);
}

void ProgressLine::show(double now, const std::optional<double>& end, std::uint64_t collisions,
                        const std::optional<double>& milling_dose) {
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
    line += fmt::format(", {:.3g}/s", static_cast<double>(collisions - first_->collisions) / spent);
  if (milling_dose && simulated > 0) line += fmt::format(", {:.3g} W", *milling_dose / simulated);
  if (end && simulated > 0) {
    const double left = spent * (*end - now) / simulated;
    line += fmt::format(", {}:{:02} left", static_cast<long>(left) / 60, static_cast<long>(left) % 60);
  }
  show(line);
}

void ProgressLine::show(const std::string& text) {
  io::tell("{}{}", no_line, text);
  visible_ = true;
}

}  // namespace edmill::cli
