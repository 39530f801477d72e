// The live line of long work, on a terminal only.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

namespace edmill::cli {

/// Takes a line of progress away.
inline constexpr const char* no_line = "\r\x1b[K";

/// Whether progress is to be shown: standard error is a terminal, and nobody asked for quiet.
bool shows_progress(bool quiet);

/// Writes the progress line to standard error; it goes with this object.
class ProgressLine {
 public:
  ProgressLine();
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  /// @param now           simulated time [s]
  /// @param end           where it ends [s]; nothing when only other rules stop the run
  /// @param collisions    since the start of the run
  /// @param milling_dose  since this line was made [J]
  void show(double now, const std::optional<double>& end, std::uint64_t collisions,
            const std::optional<double>& milling_dose = std::nullopt);
  void show(const std::string& text);

 private:
  using Clock = std::chrono::steady_clock;
  struct Look {
    Clock::time_point time;
    double now;
    std::uint64_t collisions;
  };
  std::optional<Look> first_;  ///< a resumed run did not begin here
  Clock::time_point shown_;
  bool visible_ = false;
};

}  // namespace edmill::cli
