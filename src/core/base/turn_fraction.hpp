// A part of a turn, known far beyond any scalar.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "base/errors.hpp"
#include "base/scalar.hpp"

namespace edmill {

/// A share of a turn as a binary fraction of 1024 bits, or more where a scalar needs them. What many drive
/// periods turn is reduced to less than a turn by whole numbers, so that a phase is as sharp after 1e9
/// periods as in the first one.
struct TurnFraction {
  static constexpr std::size_t words = 16;
  std::array<std::uint64_t, words> bits{};  ///< the most significant word first; [0, 1) turns
  std::vector<std::uint64_t> further{};     ///< the words after these
  std::int64_t whole = 0;                   ///< turns beside them

  /// Words that `times` takes for a scalar of so many binary digits.
  static constexpr std::size_t words_for(int digits) { return static_cast<std::size_t>(digits) / 64 + 2; }
  std::uint64_t word(std::size_t k) const { return k < words ? bits[k] : further[k - words]; }

  /// All turns, rounded.
  template <class Real>
  Real value() const {
    Real sum(0);
    for (std::size_t k = words + further.size(); k-- > 0;) sum = (sum + Real(word(k))) * Real(0x1p-64);
    return Real(whole) + sum;
  }

  /// What `count` times the fraction leaves over whole turns, from -1/2 to 1/2. Error: the rounding of the
  /// result, and |count| units of a bit that is 64 places and more beyond those of the scalar.
  template <class Real>
  Real times(std::int64_t count) const {
    if constexpr (std::numeric_limits<Real>::digits > 0) {
      constexpr std::size_t used = words_for(std::numeric_limits<Real>::digits);
      static_assert(used <= words);
      return of_product<Real>(count, std::array<std::uint64_t, used>{});
    } else {
      const std::size_t used = words_for(binary_digits<Real>());
      EDMILL_REQUIRE(used <= words + further.size(), "a turn's fraction has the digits of the scalar");
      return of_product<Real>(count, std::vector<std::uint64_t>(used));
    }
  }
  bool is_whole() const { return bits == decltype(bits){}; }
  bool operator==(const TurnFraction&) const = default;

 private:
  template <class Real, class Words>
  Real of_product(std::int64_t count, Words product) const {
    const std::size_t used = product.size();
    const bool negative = count < 0;
    const auto factor = negative ? 0 - static_cast<std::uint64_t>(count) : static_cast<std::uint64_t>(count);
    unsigned __int128 carry = 0;
    for (std::size_t k = used; k-- > 0;) {
      carry += static_cast<unsigned __int128>(word(k)) * factor;
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

}  // namespace edmill
