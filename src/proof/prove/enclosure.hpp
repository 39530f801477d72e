// Real numbers known to within a radius: Arb's balls with operators.
#pragma once

#include <arb.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <string>

#include "base/vector.hpp"
#include "casefile/quantity.hpp"

namespace edmill::prove {

/// Thrown if an enclosure is too wide for a decision, which `what` names. More bits may help.
struct Undecided {
  std::string what;
};

/// Bits of all arithmetic in the scope. Scopes nest; they belong to one thread.
class Precision {
 public:
  explicit Precision(slong bits) : before_(current) { current = bits; }
  ~Precision() { current = before_; }
  Precision(const Precision&) = delete;
  Precision& operator=(const Precision&) = delete;
  static slong bits() { return current; }
 private:
  static inline thread_local slong current = 64;
  slong before_;
};

/// All real numbers within a radius of a midpoint. Each operation encloses the exact results.
class Enclosure {
 public:
  Enclosure() { arb_init(ball_); }
  Enclosure(int x) : Enclosure() { arb_set_si(ball_, x); }  // NOLINT: numbers of formulas
  explicit Enclosure(double x) : Enclosure() { arb_set_d(ball_, x); }
  Enclosure(const Enclosure& other) : Enclosure() { arb_set(ball_, other.ball_); }
  Enclosure(Enclosure&& other) noexcept : Enclosure() { arb_swap(ball_, other.ball_); }
  Enclosure& operator=(Enclosure other) noexcept {
    arb_swap(ball_, other.ball_);
    return *this;
  }
  ~Enclosure() { arb_clear(ball_); }

  arb_ptr arb() { return ball_; }
  arb_srcptr arb() const { return ball_; }

  friend Enclosure operator+(const Enclosure& a, const Enclosure& b) { return by(arb_add, a, b); }
  friend Enclosure operator-(const Enclosure& a, const Enclosure& b) { return by(arb_sub, a, b); }
  friend Enclosure operator*(const Enclosure& a, const Enclosure& b) { return by(arb_mul, a, b); }
  friend Enclosure operator/(const Enclosure& a, const Enclosure& b) { return by(arb_div, a, b); }
  Enclosure operator-() const { return by(arb_neg, *this); }
  Enclosure& operator+=(const Enclosure& b) { return *this = *this + b; }
  Enclosure& operator-=(const Enclosure& b) { return *this = *this - b; }
  Enclosure& operator*=(const Enclosure& b) { return *this = *this * b; }
  Enclosure& operator/=(const Enclosure& b) { return *this = *this / b; }

  bool is_zero() const { return arb_is_zero(ball_); }
  bool is_positive() const { return arb_is_positive(ball_); }
  bool is_negative() const { return arb_is_negative(ball_); }
  bool is_not_negative() const { return arb_is_nonnegative(ball_); }
  bool is_not_positive() const { return arb_is_nonpositive(ball_); }

  // Midpoint, radius and ends are exact.
  Enclosure middle() const { return by(arb_get_mid_arb, *this); }
  Enclosure radius() const { return by(arb_get_rad_arb, *this); }
  Enclosure low() const { return by(arb_sub, middle(), radius(), ARF_PREC_EXACT); }
  Enclosure high() const { return by(arb_add, middle(), radius(), ARF_PREC_EXACT); }
 private:
  template <class Operation> static Enclosure by(const Operation& operation, const Enclosure& a) {
    Enclosure result;
    operation(result.ball_, a.ball_);
    return result;
  }
  template <class Operation>
  static Enclosure by(const Operation& operation, const Enclosure& a, const Enclosure& b,
      slong bits = Precision::bits()) {
    Enclosure result;
    operation(result.ball_, a.ball_, b.ball_, bits);
    return result;
  }
  arb_t ball_;
};

inline Enclosure sqrt(const Enclosure& a) {
  Enclosure result;
  arb_sqrtpos(result.arb(), a.arb(), Precision::bits());
  return result;
}

struct SinCos {
  Enclosure sin, cos;
};
inline SinCos sin_cos_turns(const Enclosure& turns) {
  SinCos result;
  const Enclosure half_turns = turns + turns;
  arb_sin_cos_pi(result.sin.arb(), result.cos.arb(), half_turns.arb(), Precision::bits());
  return result;
}

/// Whether a < b for all numbers of both.
inline bool less(const Enclosure& a, const Enclosure& b) { return arb_lt(a.arb(), b.arb()); }

}  // namespace edmill::prove

template <>
struct Eigen::NumTraits<edmill::prove::Enclosure>
    : Eigen::GenericNumTraits<edmill::prove::Enclosure> {
  enum { IsSigned = 1, ReadCost = 6, AddCost = 150, MulCost = 100 };
};

namespace edmill::prove {

using Vector = Vec3<Enclosure>;
using Matrix = Eigen::Matrix<Enclosure, 3, 3>;

Vector each(const auto& v, const auto& change) {
  return {change(v[0]), change(v[1]), change(v[2])};
}

/// Encloses an exact quantity, in the current precision.
Enclosure enclosure_of(const casefile::Quantity& quantity);
inline Vector enclosure_of(const std::array<casefile::Quantity, 3>& exact) {
  return each(exact, [](const auto& component) { return enclosure_of(component); });
}

/// An enclosure of `value` whose midpoint has `bits` bits.
inline Enclosure rounded(const Enclosure& value, slong bits) {
  Enclosure result;
  arb_set_round(result.arb(), value.arb(), bits);  // what the midpoint loses is added to the radius
  return result;
}

/// A slightly wider enclosure with few digits: the midpoint keeps 20 bits beyond the radius (`bits`
/// bits if the value is exact); the radius grows by 2^-20 and is rounded up to ten bits.
inline Enclosure rounded_out(const Enclosure& value, slong bits) {
  if (arb_is_exact(value.arb()) && arb_bits(value.arb()) <= bits) return value;
  Enclosure result = rounded(value,
      arb_is_exact(value.arb()) ? bits
                                : std::max<slong>(arb_rel_accuracy_bits(value.arb()) + 22, 22));
  const auto radius = result.radius();
  Enclosure more;
  arb_mul_2exp_si(more.arb(), radius.arb(), -20);
  arb_add(more.arb(), more.arb(), radius.arb(), ARF_PREC_EXACT);
  const auto size = arb_midref(more.arb());
  arf_set_round(size, size, 10, ARF_RND_UP);
  arf_get_mag_lower(arb_radref(result.arb()), size);  // exact: a radius has 30 bits
  return result;
}

}  // namespace edmill::prove
