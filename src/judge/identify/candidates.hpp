// Numbers and mistakes that may explain a log, each fitted and judged by itself: by the rows of its events,
// or, where the log has no states, by runs.
#pragma once

#include <cstdint>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "identify/fit.hpp"
#include "identify/identify.hpp"

namespace edmill::identify {

/// Which events of a log a fit takes: half of them such as violate something, half of them any, evenly over a
/// span.
class Samples {
 public:
  using Places = std::vector<std::size_t>;

  /// @param events  at least one; they must outlive the samples
  /// @param period  of the drive [s]
  Samples(const std::vector<audit::LoggedEvent>& events, double period) : events_(&events), period_(period) {}

  /// Draws them again. @param violating  events
  void choose(std::set<std::size_t> violating);

  const Places& few() const { return few_; }               ///< of the whole log
  const Places& whole() const { return windows_.back(); }  ///< the same, more
  const Places& many() const { return many_; }             ///< the same, for a last fit
  const Places& early() const { return windows_.front(); }
  /// Samples of growing spans, the last of the whole log: a motion's speed is fitted from the first on.
  const std::vector<Places>& windows() const { return windows_; }

 private:
  Places sample(double until, std::size_t most) const;

  const std::vector<audit::LoggedEvent>* events_;
  double period_;
  std::set<std::size_t> violating_;
  std::vector<Places> windows_;
  Places few_, many_;
};

inline constexpr double strong_evidence = 10;  ///< least gain of Schwarz's criterion (Kass and Raftery 1995)

/// A combination of free numbers and mistakes, fitted.
struct Candidate {
  Model model;
  std::vector<std::string> mistakes;
  std::vector<double> values, half_widths;
  double criterion = 0;            ///< misfit + parameters ln(rows) + what each of the choices costs
  std::uint64_t left = 0, of = 0;  ///< violations with it and without, or events that are off
  double plainness = 0;            ///< of factors with a name, which are no coincidence

  /// The least is the best.
  double rank() const { return criterion - plainness; }
  /// Without the cost of choices: what the log says.
  double evidence() const;

  Assumptions assumed() const { return model.with(values); }
  std::size_t complexity() const { return model.free.size() + mistakes.size(); }
  std::set<std::string> names() const;
};

void sort(std::vector<Candidate>& list);

/// A mistake and the misfit that it leaves.
struct Tried {
  double misfit;
  Mistake mistake;
};

/// What all candidates are judged by: a log, samples of it, and the rows of these.
class Candidates {
 public:
  /// The log and the rest must outlive it. @pre the log has events
  /// @param violations  what an audit finds without any cause
  Candidates(const audit::EventsAtHand& log, const audit::Options& options,
             const model::Case<double>& the_case, const Assumptions& nominal, std::uint64_t violations);

  /// Whether there are rows enough.
  bool suffice() const { return residuals_.on(samples_.whole()).count() >= 12; }
  /// Samples with the events that these assumptions leave off by more than the audit allows.
  void draw_samples(const std::vector<Assumptions>& assumptions);
  /// The criterion of no cause, and what an audit says of the log.
  double without() const { return without_; }
  std::uint64_t violations() const { return violations_; }
  std::size_t part_count() const { return parts_.size(); }

  /// With the present samples: sets `criterion`.
  void judge(Candidate& c) const;
  Candidate with_mistakes(const Assumptions& base, const std::vector<std::string>& names) const;
  /// Fits over growing spans where a motion's speed is free, and over the whole log.
  Candidate fitted(const Model& model, const std::vector<std::string>& mistakes,
                   const std::vector<double>& start) const;
  /// Values to begin a fit with, from afar where the rows are periodic in the parameter.
  std::vector<double> starts(const Assumptions& base, const Parameter& p) const;
  /// The fit with the final sample, and what the audit says of it.
  bool accept(Candidate& c) const;

  /// Mistakes that make the rows fit better, the best first.
  std::vector<Tried> promising(const Assumptions& base, const std::vector<Mistake>& mistakes,
                               std::size_t most) const;
  /// The parameters whose fit promises most on top of a base, by a linear fit of the rows that tell most, and
  /// by values far off.
  std::vector<const Parameter*> ranked(const Assumptions& base, const std::vector<Parameter>& parameters,
                                       std::size_t most) const;
  /// The same of parameters in a part of the log, where that share of what is off with the base lies in the
  /// part.
  std::vector<Parameter> ranked_in_parts(const Assumptions& base, const std::vector<Parameter>& parameters,
                                         std::size_t most, double share) const;
  /// Two parameters with the changes that a linear fit finds, in their units; the best first.
  struct Pair {
    double misfit;
    std::size_t one, two;
    std::vector<double> start;
  };
  std::vector<Pair> ranked_pairs(const std::vector<Parameter>& parameters) const;

 private:
  /// Rows of the first span, where a wrong speed has not gone far; of the whole log when that span shows
  /// nothing.
  Residuals telling(const Assumptions& base) const;
  bool rows_vanish(const Assumptions& assumed) const;
  std::vector<const Parameter*> telling_from_afar(const Assumptions& base,
                                                  const std::vector<Parameter>& parameters,
                                                  std::size_t most) const;
  std::vector<Parameter> telling_from_afar_in_parts(const Assumptions& base,
                                                    const std::vector<Parameter>& parameters,
                                                    const std::vector<std::size_t>& parts,
                                                    std::size_t most) const;
  void widen(Candidate& c, std::size_t place) const;
  /// What an audit finds with these assumptions; events that are off where a case does not say all of them.
  void count_violations(Candidate& c) const;
  std::set<std::size_t> events_off(const Assumptions& assumed) const;

  const audit::EventsAtHand& log_;
  const audit::Options& options_;
  const Assumptions& nominal_;
  LogResiduals residuals_;
  std::vector<SharedSubset> parts_;
  Samples samples_;
  std::uint64_t violations_;
  double without_ = 0;
};

/// Logs without states: the case is run again with other values, from its own initial state, until its
/// impacts are those of the log. docs/audit.md, "Causes"
/// @param is_interrupted  asked between runs; yes ends the search
/// @return how many impacts the case follows, and the best cause with which nine tenths can be followed
Identification replay(const Assumptions& nominal, const std::vector<Parameter>& parameters,
                      const std::vector<Mistake>& mistakes, const audit::EventsAtHand& log,
                      const std::function<bool()>& is_interrupted);

}  // namespace edmill::identify
