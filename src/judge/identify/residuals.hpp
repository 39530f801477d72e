// How far logged impacts and flights are from a model: the rows of a fit.
#pragma once

#include <cstddef>
#include <vector>

#include "audit/audit.hpp"
#include "audit/mechanics.hpp"
#include "identify/assumptions.hpp"
#include "identify/subsets.hpp"

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

}  // namespace edmill::identify
