// The kinds of findings of an audit, and their storage: counts and the worst examples of each kind.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace edmill::audit {

/// docs/audit.md defines each kind.
enum class Kind : std::size_t {
  out_of_order,
  duplicate,
  unknown_body,
  not_finite,
  late_event,
  early_event,
  wrong_partner,
  rotation_order,
  not_approaching,
  normal_restitution,
  separation_law,
  tangential_restitution,
  tangential_sign,
  unequal_balls,
  wall_velocity,
  momentum,
  spin_change,
  approach_speed,
  slip_speed,
  milling_dose,
  wall_work,
  non_ballistic,
  lost_spin,
  missed_event,
};
inline constexpr std::size_t kind_count = 24;

/// The checks; the share of a kind is relative to how often its check was made.
enum class Check : std::size_t {
  order,
  bodies,
  touch,
  approach,
  normal_law,
  tangential_law,
  momentum,
  spin_change,
  approach_speed,
  slip_speed,
  milling_dose,
  wall_work,
  flight,
  spin_kept,
  missed,
};
inline constexpr std::size_t check_count = 15;

struct KindInfo {
  std::string_view name, unit;  ///< unit of its size
  std::string_view meaning;     ///< in a few words
  Check check;                  ///< that finds it
};
const KindInfo& info(Kind kind);

struct CheckInfo {
  std::string_view name;
  std::string_view columns;  ///< that it needs
};
const CheckInfo& info(Check check);

struct Finding {
  Kind kind;
  double size;         ///< size of the violation, in the unit of the kind
  std::uint64_t line;  ///< of the log
  double time;         ///< [s]
  int ball;
  bool with_wall;
  int partner;
  double found, expected;  ///< nan where they do not apply
  const char* note = "";   ///< a literal: what the finding looks like
  bool explained = false;  ///< the note is a mistake that makes the violation vanish
};

/// All findings of one kind. Bounded memory: notes are literals of the program.
struct Tally {
  std::uint64_t count = 0, explained = 0;
  double worst = 0;
  std::vector<Finding> examples;  ///< the worst, largest first
  std::map<std::string_view, std::uint64_t> notes;
};

class Findings {
 public:
  /// @param examples  kept of each kind
  explicit Findings(std::size_t examples) : examples_(examples) {}

  void add(const Finding& finding);
  void judged(Check check) { ++judged_[static_cast<std::size_t>(check)]; }
  /// The tolerance of what would be checked is as large as itself.
  void unresolved(Check check) { ++unresolved_[static_cast<std::size_t>(check)]; }
  /// Takes what others have found.
  void take(const Findings& others);

  const Tally& of(Kind kind) const { return tallies_[static_cast<std::size_t>(kind)]; }
  std::uint64_t judged_number(Check check) const { return judged_[static_cast<std::size_t>(check)]; }
  std::uint64_t unresolved_number(Check check) const { return unresolved_[static_cast<std::size_t>(check)]; }
  std::uint64_t total() const;
  /// Number of violations that their notes explain.
  std::uint64_t explained() const;
  /// Kinds that were found, the most frequent first.
  std::vector<Kind> ranked() const;

  std::size_t examples() const { return examples_; }

 private:
  void keep(Tally& tally, const Finding& finding) const;

  std::size_t examples_;
  std::array<Tally, kind_count> tallies_;
  std::array<std::uint64_t, check_count> judged_{}, unresolved_{};
};

}  // namespace edmill::audit
