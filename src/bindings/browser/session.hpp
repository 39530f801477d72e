// A run that a page shows while it goes on.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "casefile/case_spec.hpp"
#include "edmill/run.hpp"
#include "io/json_text.hpp"
#include "model/mill.hpp"

namespace edmill::browser {

/// The first impacts of a case as JSON: lists `time` [s], `ball`, `partner`, a wall as -1 - its number.
/// @throws InputError
void first_impacts(const std::string& text, const std::vector<std::string>& settings, int most,
                   io::JsonText& json);

/// The text of a case whose values are those of its settings, so that it is the same case without them. Where
/// that cannot be done line by line, settings follow as comments.
/// @param log  whether an output "collisions" is added unless the case has one
std::string text_with_values(const casefile::CaseSpec& spec, bool log);

/// The bytes of a file; none where there is no such file.
std::string content_of(const std::string& place);

class Session : private Observer<double> {
 public:
  /// @param settings  "section.key=value" over the text, whose own outputs are left out
  /// @param log       whether collisions.csv is written
  /// @throws InputError with all problems of the case
  Session(const std::string& text, const std::vector<std::string>& settings, bool log);

  /// What stands still, as JSON: radii, walls as meshes, names of partners, digest of the case, the period.
  void scene(io::JsonText& json) const;
  /// Simulates up to a time [s], or to the next impact, but for no longer than a hundred drive periods.
  void advance_to(double time);
  void advance_one_impact();
  /// The present state as JSON: places, the vessel's frame, rates with intervals, counts by approach speed.
  void frame(io::JsonText& json);
  /// The case with the settings in it, as a file that the command line runs: with the same log, if any.
  std::string case_text() const;
  /// The summary, and the SHA-256 of collisions.csv as the command line writes it. Nothing can follow.
  void finish(io::JsonText& json);

 private:
  void on_impact(const Impact<double>& impact, Run<double>& run) override;

  casefile::CaseSpec spec_;
  model::Mill<double> mill_;
  Run<double> run_;
  std::array<std::uint64_t, 40> by_speed_{};  ///< impacts, in classes of equal ratio from 1 mm/s to 10 m/s
  std::uint64_t impacts_ = 0;
  Impact<double> last_{};
  bool log_, going_on_ = true, finished_ = false;
};

}  // namespace edmill::browser
