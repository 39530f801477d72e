// A part of a turn, known far beyond any scalar.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace edmill {

/// A share of a turn as a binary fraction of 1024 bits. What many drive periods turn is reduced to less than
/// a turn by whole numbers, so that a phase is as sharp after 1e9 periods as in the first one.
struct TurnFraction {
  static constexpr std::size_t words = 16;
  std::array<std::uint64_t, words> bits{};  ///< the most significant word first; [0, 1) turns
  std::int64_t whole = 0;                   ///< turns beside them

  /// All turns, rounded.
  template <class Real>
  Real value() const {
    Real sum(0);
    for (std::size_t k = words; k-- > 0;) sum = (sum + Real(bits[k])) * Real(0x1p-64);
    return Real(whole) + sum;
  }

  /// What `count` times the fraction leaves over whole turns, from -1/2 to 1/2. Error: the rounding of the
  /// result, and |count| units of a bit that is 64 places and more behind those of the scalar.
  template <class Real>
  Real times(std::int64_t count) const {
    constexpr std::size_t digits = static_cast<std::size_t>(std::numeric_limits<Real>::digits);
    constexpr std::size_t used = digits / 64 + 2;
    static_assert(used <= words);
    std::array<std::uint64_t, used> product;
    const bool negative = count < 0;
    const auto factor = negative ? 0 - static_cast<std::uint64_t>(count) : static_cast<std::uint64_t>(count);
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
  bool is_whole() const { return bits == decltype(bits){}; }
  bool operator==(const TurnFraction&) const = default;
};

}  // namespace edmill
