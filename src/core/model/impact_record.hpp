// Impacts in logs: the one list of their quantities, that of their vectors, and one impact of a
// log.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace edmill::model {

/// Quantities of an impact that logs contain and comparisons use; SI.
enum Logged : std::size_t {
  time,
  approach_speed,
  slip_speed,
  milling_dose,
  wall_work,
  logged_count
};

struct LoggedQuantity {
  std::string_view name, unit, meaning;
};
/// In the order of the columns of collisions.csv.
inline constexpr std::array<LoggedQuantity, logged_count> logged_quantities{{
    {"time", "s", "instant of the impact"},
    {"approach_speed", "m/s", "normal relative speed at the contact point before"},
    {"slip_speed", "m/s", "tangential relative speed at the contact point before"},
    {"milling_dose", "J", "kinetic energy that the impact dissipates"},
    {"wall_work", "J", "work of the wall on the ball"},
}};

/// A logged vector of one body of an impact, in the inertial frame. A wall as partner has none.
struct LoggedVector {
  std::string_view name, unit;
  std::string_view letter,
      when;  ///< of its columns in a CSV file: "v" and "_before" of "vx_before"
};
inline constexpr std::array<LoggedVector, 5> logged_vectors{{
    {"position", "m", "", ""},
    {"velocity_before", "m/s", "v", "_before"},
    {"spin_before", "rad/s", "w", "_before"},
    {"velocity_after", "m/s", "v", "_after"},
    {"spin_after", "rad/s", "w", "_after"},
}};

/// Calls `use` with the names "x" to "wz_after" and "partner_x" to "partner_wz_after", in the order
/// of the columns.
void for_logged_vectors(auto&& use) {
  for (const std::string body : {"", "partner_"})
    for (const auto& vector : logged_vectors)
      for (const char* axis : {"x", "y", "z"})
        use(body + std::string(vector.letter) + axis + std::string(vector.when));
}

/// One impact of a log, or of a run that is compared with a log.
template <class Number> struct ImpactRecord {
  int ball = 0;
  bool with_wall = false;
  int partner = 0;  ///< ball or wall id
  Number time{}, approach_speed{}, slip_speed{}, milling_dose{},
      wall_work{};         ///< nan where a log has none
  std::uint64_t line = 0;  ///< in the file, from 1; 0 for an impact of a run
  bool by_rule = false;    ///< another contact has the same time, and a rule put this one first

  Number& operator[](std::size_t quantity) { return this->*members[quantity]; }
  const Number& operator[](std::size_t quantity) const { return this->*members[quantity]; }

  /// Swaps two balls if necessary, so that the lower number comes first.
  void put_in_order() {
    if (!with_wall && partner < ball) std::swap(ball, partner);
  }
  bool same_bodies(const ImpactRecord& other) const {
    if (with_wall != other.with_wall) return false;
    return (ball == other.ball && partner == other.partner) ||
        (!with_wall && ball == other.partner && partner == other.ball);
  }
 private:
  static constexpr std::array<Number ImpactRecord::*, logged_count> members{&ImpactRecord::time,
      &ImpactRecord::approach_speed, &ImpactRecord::slip_speed, &ImpactRecord::milling_dose,
      &ImpactRecord::wall_work};
};

}  // namespace edmill::model
