// The findings of an audit: counts and the worst examples of each kind.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <string_view>
#include <vector>

#include "base/sums.hpp"
#include "model/impact_record.hpp"

namespace edmill::audit {

#define EDMILL_KIND(name, unit, meaning, check) name,
enum class Kind : std::size_t {
#include "audit/findings.def"
};
#undef EDMILL_KIND
/// Checks, each of which finds one or several kinds. A kind's share is relative to those made.
#define EDMILL_CHECK(id, name, rows, columns) id,
enum class Check : std::size_t {
#include "audit/findings.def"
};
#undef EDMILL_CHECK

struct KindInfo {
  std::string_view name, unit;  ///< unit of its size
  std::string_view meaning;     ///< in a few words
  Check check;                  ///< that finds it
};
#define EDMILL_KIND(name, unit, meaning, check) KindInfo{#name, unit, meaning, Check::check},
inline constexpr std::array kinds{
#include "audit/findings.def"
};
#undef EDMILL_KIND
/// The quantity of a row; rows of one kind share a scale of noise.
enum class RowKind : unsigned char { touch, law, energy, speed, place, velocity };
inline constexpr std::size_t row_kinds = 6;
struct CheckInfo {
  std::string_view name;
  RowKind rows;
  std::string_view columns;  ///< that it needs
};
#define EDMILL_CHECK(id, name, rows, columns) CheckInfo{name, RowKind::rows, columns},
inline constexpr std::array checks{
#include "audit/findings.def"
};
#undef EDMILL_CHECK
inline constexpr std::size_t kind_count = kinds.size(), check_count = checks.size();
constexpr std::size_t at(auto number) { return static_cast<std::size_t>(number); }
inline const KindInfo& info(Kind kind) { return kinds[at(kind)]; }
/// The kind of violation that a check finds. @pre it finds only one kind
constexpr Kind kind_of(Check check) {
  const auto first =
      std::find_if(kinds.begin(), kinds.end(), [&](const KindInfo& k) { return k.check == check; });
  return static_cast<Kind>(first - kinds.begin());
}
inline const CheckInfo& info(Check check) { return checks[at(check)]; }
/// The checks for which `wanted` is true or not 0.
std::vector<Check> checks_with(const auto& wanted) {
  std::vector<Check> list;
  for (std::size_t k = 0; k < check_count; ++k)
    if (const auto check = static_cast<Check>(k); wanted(check)) list.push_back(check);
  return list;
}

struct Finding : model::ImpactRecord<double> {
  Kind kind;
  double size;             ///< of the violation, in the unit of the kind
  double found, expected;  ///< nan where they do not apply
  const char* note = "";   ///< a literal: a probable reason
};

struct Tally {
  std::uint64_t count = 0;
  double worst = 0;
  std::vector<Finding> examples;  ///< the worst, largest first
  std::map<std::string_view, std::uint64_t> notes;
};

class Findings {
 public:
  /// @param examples  number of examples kept of each kind
  explicit Findings(std::size_t examples) : examples_(examples) {}

  void add(const Finding& finding) {
    Tally& tally = tallies_[at(finding.kind)];
    ++tally.count;
    if (*finding.note != '\0') ++tally.notes[finding.note];
    keep(tally, finding);
  }
  void judged(Check check) { ++judged_[at(check)]; }
  /// Counts a check that was not made because the tolerance is as large as the checked quantity.
  void unresolved(Check check) { ++unresolved_[at(check)]; }
  const Tally& of(Kind kind) const { return tallies_[at(kind)]; }
  std::uint64_t judged_number(Check check) const { return judged_[at(check)]; }
  std::uint64_t unresolved_number(Check check) const { return unresolved_[at(check)]; }
  std::uint64_t total() const {
    return std::accumulate(tallies_.begin(), tallies_.end(), std::uint64_t{0},
                           [](std::uint64_t sum, const Tally& tally) { return sum + tally.count; });
  }
  /// Kinds that were found, the most frequent first.
  std::vector<Kind> ranked() const {
    std::vector<Kind> found;
    for (std::size_t k = 0; k < kind_count; ++k)
      if (tallies_[k].count > 0) found.push_back(static_cast<Kind>(k));
    std::stable_sort(found.begin(), found.end(), [&](auto a, auto b) { return of(a).count > of(b).count; });
    return found;
  }

 private:
  void keep(Tally& tally, const Finding& finding) const {
    tally.worst = std::max(tally.worst, finding.size);
    auto& worst = tally.examples;
    if (worst.size() == examples_ && !(examples_ > 0 && finding.size > worst.back().size)) return;
    const auto place = std::upper_bound(worst.begin(), worst.end(), finding,
                                        [](const Finding& a, const Finding& b) { return a.size > b.size; });
    worst.insert(place, finding);
    if (worst.size() > examples_) worst.pop_back();
  }

  std::size_t examples_;
  std::array<Tally, kind_count> tallies_;
  std::array<std::uint64_t, check_count> judged_{}, unresolved_{};
};

/// Totals over the impacts of a log that have velocities and spins before and after.
struct Energies {
  using Sum = numerics::CompensatedSum<double>;
  std::uint64_t impacts = 0;
  Sum wall_work;                ///< of the logged states [J]
  Sum milling_dose;             ///< as logged, otherwise from the law [J]
  Sum supplied;                 ///< that the case's least separation speed adds [J]
  Sum kinetic_change;           ///< of the logged states [J]
  std::uint64_t supplying = 0;  ///< number of impacts in which it adds energy
  std::uint64_t creating = 0;   ///< number of impacts that create more energy than that
  double created = 0;           ///< energy that those create [J]

  /// 0 up to rounding in a log that obeys the law [J].
  double closure() const {
    return (wall_work.value() - milling_dose.value()) + (supplied.value() - kinetic_change.value());
  }
};

/// True if an assumption explains a violation: the residual with it is within the tolerance and, where that
/// is coarse, at most a tenth of the one without it.
inline bool vanishes(double without, double with, double allowed) {
  return with <= allowed && 10 * with <= without;
}

/// True if a cause explains at least nine tenths of the violations; others may have another.
inline bool accounts_for(std::uint64_t explained, std::uint64_t of) {
  return explained > 0 && 10 * explained >= 9 * of;
}

}  // namespace edmill::audit
