// The joints of a chain, as a case gives them, and harmonic functions of time whose phases stay as
// accurate as at the start.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/errors.hpp"
#include "base/instant.hpp"
#include "base/scalar.hpp"
#include "base/trigonometry.hpp"

namespace edmill::model {

/// A fraction of a turn as a binary fraction of 1024 bits, or more if a scalar needs them. The
/// angle after many drive periods is reduced to less than a turn in integer arithmetic, so that a
/// phase is as accurate after 1e9 periods as in the first one.
struct TurnFraction {
  static constexpr std::size_t words = 16;
  /// The most significant word first; [0, 1) turns.
  std::vector<std::uint64_t> bits = std::vector<std::uint64_t>(words);
  std::int64_t whole = 0;  ///< whole turns, to be added

  /// Number of words that `times` uses for a scalar with this many binary digits.
  static constexpr std::size_t words_for(int digits) {
    return static_cast<std::size_t>(digits) / 64 + 2;
  }

  /// Whole turns and fraction, rounded to the scalar.
  template <class Real> Real value() const {
    Real sum(0);
    for (std::size_t k = bits.size(); k-- > 0;) sum = (sum + Real(bits[k])) * Real(0x1p-64);
    return Real(whole) + sum;
  }

  /// `count` times the fraction, reduced by whole turns to -1/2 to 1/2. Error: the rounding of the
  /// result, and |count| units of a bit at least 64 places below the last of the scalar.
  template <class Real> Real times(std::int64_t count) const {
    if constexpr (std::numeric_limits<Real>::digits > 0) {
      constexpr std::size_t used = words_for(std::numeric_limits<Real>::digits);
      static_assert(used <= words);
      return of_product<Real>(count, std::array<std::uint64_t, used>{});
    } else {
      const std::size_t used = words_for(binary_digits<Real>());
      EDMILL_REQUIRE(used <= bits.size(), "a turn's fraction has the digits of the scalar");
      return of_product<Real>(count, std::vector<std::uint64_t>(used));
    }
  }
  bool is_whole() const {
    return std::all_of(bits.begin(), bits.end(), [](std::uint64_t word) { return word == 0; });
  }
  bool operator==(const TurnFraction&) const = default;
 private:
  template <class Real, class Words> Real of_product(std::int64_t count, Words product) const {
    const std::size_t used = product.size();
    const bool negative = count < 0;
    const auto factor =
        negative ? 0 - static_cast<std::uint64_t>(count) : static_cast<std::uint64_t>(count);
    unsigned __int128 carry = 0;
    for (std::size_t k = used; k-- > 0;) {
      carry += static_cast<unsigned __int128>(bits[k]) * factor;
      product[k] = static_cast<std::uint64_t>(carry);
      carry >>= 64;
    }
    const bool above_half = product[0] >> 63 != 0;
    if (above_half) {  // 1 - x
      std::uint64_t borrow = 1;
      for (std::size_t k = used; k-- > 0;) {
        product[k] = ~product[k] + borrow;
        borrow = borrow && product[k] == 0;
      }
    }
    Real sum(0);
    for (std::size_t k = used; k-- > 0;) sum = (sum + Real(product[k])) * Real(0x1p-64);
    return above_half != negative ? Real(-sum) : sum;
  }
};

/// amplitude sin(2 pi (frequency t + phase)).
template <class Number> struct Swing {
  Number amplitude;           ///< [m], or [turns] of a rotation
  Number frequency;           ///< [1/s], of either sign
  Number phase;               ///< [turns]
  TurnFraction per_period{};  ///< of frequency times the period of the clock
};

/// The swings with each number converted.
template <class To, class From, class Convert>
std::vector<Swing<To>> converted_swings(
    const std::vector<Swing<From>>& from, const Convert& convert) {
  std::vector<Swing<To>> to;
  for (const auto& s : from)
    to.push_back({convert(s.amplitude), convert(s.frequency), convert(s.phase), s.per_period});
  return to;
}

/// Rotation at constant speed; whole periods of the clock are subtracted from its phase exactly.
template <class Real> struct Drive {
  Real frequency{0};  ///< [1/s]
  Real speed{0};      ///< 2 pi frequency [rad/s]
  TurnFraction per_period{};
  bool whole_turns = per_period.is_whole();  ///< in every period

  Real turns(const Instant<Real>& when) const {
    const Real since = frequency * when.offset;
    return whole_turns ? since : Real(per_period.times<Real>(when.period) + since);
  }
};

/// Value and two derivatives.
template <class Real> struct Moved { Real value{0}, rate{0}, second{0}; };

/// A sum of swings, ready to be evaluated.
template <class Real> class Swings {
 public:
  Swings() = default;
  explicit Swings(const std::vector<Swing<Real>>& given) {
    for (const auto& s : given) {
      if (s.amplitude == 0) continue;
      const Real speed = 2 * numerics::pi<Real>() * s.frequency;
      list_.push_back({{s.frequency, speed, s.per_period}, s.amplitude, s.phase});
    }
  }
  bool empty() const { return list_.empty(); }

  Moved<Real> at(const Instant<Real>& when) const {
    Moved<Real> moved;
    for (const auto& swing : list_) {
      const auto phase = numerics::sin_cos_turns<Real>(swing.drive.turns(when) + swing.phase);
      const Real rate = swing.amplitude * swing.drive.speed;
      moved.value += swing.amplitude * phase.sin;
      moved.rate += rate * phase.cos;
      moved.second -= rate * swing.drive.speed * phase.sin;
    }
    return moved;
  }
 private:
  struct Driven {
    Drive<Real> drive;
    Real amplitude, phase;  ///< [m] or [turns], [turns]
  };
  std::vector<Driven> list_;
};

/// One joint of a chain: it rotates all that follows it about an axis, or translates it.
template <class Number> struct Joint {
  bool rotates = true;
  std::array<Number, 3> axis{};   ///< in the frame of the joint before; of any length
  std::array<Number, 3> shift{};  ///< of a translation [m]
  Number angle{};                 ///< of a rotation [turns]
  Number speed{};                 ///< constant, of either sign: [turns/s], or [m/s] along the axis
  TurnFraction per_period{};      ///< of the turns in a period of the clock
  std::vector<Swing<Number>> swings{};  ///< along the axis, or about it
};

/// A chain of joints from the ground to the vessel, and the period of the clock.
template <class Number> struct Joints {
  std::vector<Joint<Number>> list;
  Number period{};  ///< [s]
  /// Start and end of the run [s], between which translations at constant speed are bounded.
  std::array<Number, 2> times{};
};

/// The joints with each number converted.
template <class To, class From, class Convert>
Joints<To> converted_joints(const Joints<From>& from, const Convert& convert) {
  Joints<To> to{{}, convert(from.period), {convert(from.times[0]), convert(from.times[1])}};
  for (const auto& j : from.list) {
    to.list.push_back({.rotates = j.rotates,
        .axis = {convert(j.axis[0]), convert(j.axis[1]), convert(j.axis[2])},
        .shift = {convert(j.shift[0]), convert(j.shift[1]), convert(j.shift[2])},
        .angle = convert(j.angle),
        .speed = convert(j.speed),
        .per_period = j.per_period,
        .swings = converted_swings<To>(j.swings, convert)});
  }
  return to;
}

}  // namespace edmill::model
