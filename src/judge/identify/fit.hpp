// Residuals of logged impacts and flights with respect to a model, and their robust fit.
#pragma once

#include <Eigen/Core>
#include <set>

#include "audit/audit.hpp"
#include "identify/assumed.hpp"

namespace edmill::identify {

using audit::EventsAtHand;
using Eigen::VectorXd;

/// A component of a row for the unmodified case, with its tolerance in the audit.
struct Residual {
  double allowed;
  audit::RowKind kind;
  RowPlace at;
};

/// Residuals of the equations that an audit checks, divided by their tolerances: gaps of bodies in
/// contact, states after an impact, energies and speeds in their columns, the ends of flights. The
/// set of rows depends only on the log's columns: a fit has the same for all values.
class LogResiduals {
 public:
  /// @param nominal  case that the tolerances are computed from
  LogResiduals(const EventsAtHand& log, const audit::Tolerances& tolerances, const Case& nominal);

  const std::vector<Branches>& branches() const { return branches_; }
 private:
  friend class Residuals;
  struct Before {
    long event = -1;
    std::size_t body = 0;
  };
  audit::Rows rows_of(std::size_t event, const Case& model, const LogChange&, const Terms&) const;
  Branches branches_of(const LoggedEvent& event) const;

  const EventsAtHand& log_;
  audit::Tolerances tolerances_;
  std::vector<std::array<Before, 2>> before_;  ///< where the flight of each body began
  std::vector<bool> in_stall_;                 ///< for each event: frictionless
  std::vector<Branches> branches_;
  const Case& nominal_;
};

/// The rows of a sample of events and of the flights that end with them. `log` must outlive it.
class Residuals {
 public:
  Residuals(const LogResiduals& log, const std::vector<std::size_t>& events);

  std::size_t count() const { return of_case_.size(); }
  const std::vector<Residual>& of_case() const { return of_case_; }
  /// @return for each row its residual divided by the tolerance for the unmodified case; a large
  /// number if it is not finite, and for all rows if the assumed case is impossible
  VectorXd rows(const Assumed& assumed) const;
 private:
  VectorXd of_whole(const Assumed& assumed) const;

  const LogResiduals* log_;
  std::vector<std::size_t> chosen_;
  std::vector<Residual> of_case_;
};

/// Assumptions that together may explain a log; their numbers are fitted together.
struct Hypothesis {
  Assumed nominal;
  std::vector<Found> found = {};  ///< mistakes first: a number may be of the mill that one makes
  double score = 0;  ///< Schwarz's criterion: misfit + numbers ln(rows) + what each choice costs
  double plainness = 0;            ///< bonus for factors like 2 or -1, unlikely to be chance
  std::uint64_t left = 0, of = 0;  ///< violations, or events with some, with it and without
  std::string others = {};         ///< kinds of the violations that are left

  /// Rank of the hypothesis; lower is better.
  double rank() const { return score - plainness; }
  /// The score without the cost of choices.
  double evidence() const {
    return std::accumulate(found.begin(), found.end(), score,
        [](double sum, const Found& f) { return sum - f.what.prior; });
  }
  std::size_t size() const { return found.size(); }
  std::set<std::string> names() const {
    std::set<std::string> all;
    for (const auto& f : found) all.insert(f.what.name());
    return all;
  }
  bool allows(const Assumption& more) const {
    return std::none_of(found.begin(), found.end(),
        [&](const Found& f) { return f.what.excludes(more) || more.excludes(f.what); });
  }
  void add(const Assumption& more, double value) {
    found.insert(
        more.is_fitted() ? found.end() : found.end() - std::ssize(fitted(*this)), {more, value});
  }

  Assumed assumed() const {
    Assumed result = nominal;
    for (const auto& f : found) f.what.set(result, f.value);
    return result;
  }
};

/// 2 sum ln(1 + (r/s)^2) + 2 n ln s over the rows of a sample, with the median of |r| of each kind
/// as s: minus twice the logarithm of Cauchy's likelihood.
double misfit(const Residuals& sample, const VectorXd& rows);
inline double misfit(const Residuals& sample, const Assumed& assumed) {
  return misfit(sample, sample.rows(assumed));
}

/// Least squares by Eigen's Levenberg and Marquardt, repeated with Cauchy weights whose scale
/// shrinks from the initial residuals to the tolerance: rows with other causes lose their weight.
/// @param tried  starting values on input, the fitted values and their intervals on output
void fit(const Residuals& sample, Hypothesis& tried);

/// Derivatives of the rows by a number, at the base; empty if they do not depend on it.
VectorXd sensitivity(
    const Residuals& sample, const Assumed& base, const VectorXd& rows, const Assumption& number);

/// Misfit after the best change of a number, in which the rows are linear with this slope.
double linear_misfit(const Residuals& sample, const VectorXd& rows, const VectorXd& slope);

}  // namespace edmill::identify
