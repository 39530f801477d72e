// What a log says of mistakes and of other numbers: by the rows of its events, or, where it has no states, by
// runs.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "audit/audit.hpp"
#include "identify/fit.hpp"
#include "identify/identify.hpp"

namespace edmill::identify {

inline constexpr double strong_evidence = 10;  ///< least gain of Schwarz's criterion (Kass and Raftery 1995)

/// The best first.
void sort(std::vector<Hypothesis>& list);

/// What all hypotheses are judged by: a log, samples of it, and the rows of these.
class Evidence {
 public:
  /// The log and the rest must outlive it. @pre the log has events
  /// @param violations  what an audit finds with the case as it is
  Evidence(const audit::EventsAtHand& log, const audit::Options& options, const model::Case<double>& the_case,
           const Assumptions& nominal, std::uint64_t violations);

  /// Whether there are rows enough.
  bool suffices() const { return whole().count() >= 12; }
  /// The score of the case as it is.
  double score_of_case() const { return score_of_case_; }
  std::size_t part_count() const { return parts_.size(); }

  /// Draws the samples again: half of their events violate a row under one of these assumptions, the others
  /// are any, evenly spread over a span.
  void draw_samples(const std::vector<Assumptions>& bases);
  /// Sets the score, with the present samples.
  void judge(Hypothesis& tried) const;
  /// A hypothesis with one more mistake, or one more number fitted together with its own.
  Hypothesis with(const Hypothesis& base, const Parameter& more) const;
  /// The fit with the final sample, and what the audit says of it.
  bool accept(Hypothesis& tried) const;
  /// What a hypothesis explains of all violated rows.
  struct Explained {
    std::set<std::size_t> rows{}, events{};
  };
  /// Nothing unless it explains nine tenths of what it changes: one mistake of several.
  Explained explained_by(const Hypothesis& tried) const;
  std::set<std::size_t> violating_events(const Assumptions& assumed) const;

  /// Of mistakes, and of numbers that have no effect near their value, or another one far from it: those that
  /// fit better on top of a base with one of their trial values, the best first.
  std::vector<Parameter> by_trial_values(const Assumptions& base, const std::vector<Parameter>& list,
                                         std::size_t most) const;
  /// The numbers whose fit promises most on top of a base, by a linear fit of the rows and by trial values.
  std::vector<Parameter> best_numbers(const Assumptions& base, const std::vector<Parameter>& numbers,
                                      std::size_t most) const;
  /// Two numbers of the case, fitted together: those whose linear fit promises most.
  std::vector<Hypothesis> best_pairs(const std::vector<Parameter>& numbers, std::size_t most) const;
  /// The numbers whose fit promises most in parts of the log that contain this share of the rows violated
  /// with the base.
  std::vector<Parameter> best_in_parts(const Assumptions& base, const std::vector<Parameter>& numbers,
                                       std::size_t most, double share) const;

 private:
  const Residuals& early() const { return windows_.front(); }
  const Residuals& whole() const { return windows_.back(); }
  const Residuals& early_or_whole(const Assumptions& base) const;
  std::vector<Parameter> by_sensitivity(const Residuals& sample, const Assumptions& base,
                                        const std::vector<Parameter>& numbers,
                                        const std::vector<SharedSubset>& parts, std::size_t most) const;
  std::vector<double> starts(const Assumptions& base, const Parameter& p) const;
  /// Over growing spans where a motion's speed is free, and over the whole log.
  void fit_and_judge(Hypothesis& tried) const;
  void widen(Hypothesis& tried, std::size_t place) const;
  double vanished(const Residuals& sample, const Assumptions& assumed) const;
  /// Counts what an audit finds with these assumptions; where no case can express them all, the events with
  /// violated rows.
  void count_violations(Hypothesis& tried) const;

  const audit::EventsAtHand& log_;
  const audit::Options& options_;
  const Assumptions& nominal_;
  double period_;  ///< of the drive [s]
  LogResiduals residuals_;
  std::vector<SharedSubset> parts_;
  /// Samples of growing spans, the last of the whole log: a motion's speed is fitted from the first on.
  std::vector<Residuals> windows_;
  Residuals few_, many_;  ///< of the whole log: for trials, and for a last fit
  Residuals all_;         ///< of every event
  double early_end_ = 0;  ///< [s]
  std::uint64_t violations_;
  double score_of_case_ = 0;
};

/// Logs without states: the case is run again with other values, from its own initial state, until its
/// impacts are those of the log. docs/audit.md, "Causes"
/// @param is_interrupted  asked between runs; yes ends the search
/// @return how many impacts the case follows, and the best cause with which nine tenths can be followed
Identification replay(const Assumptions& nominal, const std::vector<Parameter>& numbers,
                      const std::vector<Parameter>& mistakes, const audit::EventsAtHand& log,
                      const std::function<bool()>& is_interrupted);

}  // namespace edmill::identify
