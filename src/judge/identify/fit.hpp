// How far logged impacts and flights are from a model: rows, and their robust least squares.
#pragma once

#include <cstddef>
#include <vector>

#include "audit/audit.hpp"
#include "audit/mechanics.hpp"
#include "identify/parameters.hpp"

namespace edmill::identify {

/// What a row compares; rows of one kind have one scale of noise.
enum class RowKind : unsigned char { touch, law, energy, speed, place, velocity };
inline constexpr std::size_t row_kinds = 6;

class Residuals;

/// The equations that an audit checks, as differences over what the audit allows: gaps of bodies in contact,
/// states after an impact, energies and speeds in their columns, the ends of flights. Which rows there are
/// depends on the columns of the log alone, so that a fit has the same rows for all values.
class LogResiduals {
 public:
  /// @param nominal  what the audit's tolerances are taken from
  LogResiduals(const audit::EventsAtHand& log, const audit::Tolerances& tolerances,
               const model::Case<double>& nominal);

  /// The rows of these events; each flight is that before its event.
  Residuals on(const std::vector<std::size_t>& events) const;
  /// By event: which branches of the case's law its states take.
  const std::vector<Branches>& branches() const { return branches_; }

 private:
  friend class Residuals;
  struct Before {
    long event = -1;
    std::size_t body = 0;
  };
  struct Writer;
  /// What a row is computed from.
  struct Given {
    const model::Case<double>& model;
    const LogChange& change;
    const Terms& terms;
  };
  void event_rows(std::size_t k, const Given& given, Writer& out) const;
  void flight_rows(std::size_t k, std::size_t body, const audit::LoggedEvent& event, const Given& given,
                   Writer& out) const;
  void impact_rows(const audit::LoggedImpact& impact, const Terms& terms, Writer& out) const;
  void energy_rows(const audit::LoggedImpact& impact, const audit::Speeds& speeds, const Terms& terms,
                   double allowed, Writer& out) const;
  void speed_rows(const audit::LoggedImpact& impact, const Terms& terms, Writer& out) const;
  Branches branches_of(const audit::LoggedEvent& event) const;

  const audit::EventsAtHand& log_;
  audit::Tolerances tolerances_;
  std::vector<std::array<Before, 2>> before_;  ///< the impact at which the flight of each body began
  std::vector<bool> in_stall_;                 ///< by event: friction rests
  std::vector<Branches> branches_;
  const model::Case<double>& nominal_;
};

/// The rows of a sample of events. What it was made from must outlive it.
class Residuals {
 public:
  std::size_t count() const { return kinds_.size(); }
  const std::vector<RowKind>& kinds() const { return kinds_; }
  /// Where each row stands.
  const std::vector<RowPlace>& places() const { return places_; }
  /// @return one number for each row; a large one where it is not finite, and all of them for a case that
  /// cannot be
  std::vector<double> rows(const Assumptions& assumed) const;

 private:
  friend class LogResiduals;
  explicit Residuals(const LogResiduals& log) : log_(&log) {}

  std::vector<double> of_whole(const Assumptions& assumed) const;

  const LogResiduals* log_;
  std::vector<std::size_t> chosen_;
  std::vector<double> allowed_;  ///< by row
  std::vector<RowKind> kinds_;
  std::vector<RowPlace> places_;
};

/// Parameters that are fitted together, on top of assumptions that hold already.
struct Model {
  Assumptions base;
  std::vector<const Parameter*> free;

  Assumptions with(const std::vector<double>& values) const;
};

struct Fit {
  std::vector<double> values,
      half_widths;  ///< SI; the intervals hold 99.7 % of normal noise, and a common shift
  double cost = 0;  ///< `misfit` of the rows
};

/// 2 sum ln(1 + (r/s)^2) + 2 n ln s over the rows, with the median of |r| of each kind as s: minus twice the
/// log of Cauchy's likelihood. Wild rows count little, and rows that fit by orders of magnitude better count
/// much.
double misfit(const std::vector<double>& rows, const std::vector<RowKind>& kinds);
inline double misfit(const Residuals& sample, const Assumptions& assumed) {
  return misfit(sample.rows(assumed), sample.kinds());
}

/// Least squares by Eigen's Levenberg and Marquardt (that of MINPACK), repeated with Cauchy weights whose
/// scale shrinks from the misfits of the start down to the tolerance, so that rows with other causes lose
/// their say.
/// @param start  values to begin with
Fit fit(const Residuals& residuals, const Model& model, std::vector<double> start);

/// Derivatives of the rows by each parameter, at the base; empty for one that the rows do not depend on.
std::vector<std::vector<double>> slopes_of(const Residuals& residuals, const Assumptions& base,
                                           const std::vector<Parameter>& parameters);

/// The change of the parameters that explains the rows best if they are linear in them, in units of
/// `columns`.
/// @param columns  derivative of the rows by each parameter
/// @return the misfit that is left
double linear_misfit(const std::vector<double>& rows, const std::vector<RowKind>& kinds,
                     const std::vector<const std::vector<double>*>& columns, std::vector<double>& change);

}  // namespace edmill::identify
