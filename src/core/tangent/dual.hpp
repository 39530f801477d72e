// Numbers with a derivative along one direction: forward-mode differentiation of what is a template of its
// scalar.
#pragma once

#include <cmath>
#include <limits>

#include "base/trigonometry.hpp"
#include "base/vector.hpp"

namespace edmill::tangent {

/// value + slope e with e^2 = 0. Comparisons are those of the values: a branch is that of the motion itself.
template <class Real>
struct Dual {
  Real value{0};
  Real slope{0};

  Dual() = default;
  Dual(const Real& v) : value(v) {}             // NOLINT(google-explicit-constructor): a constant
  Dual(int v) : value(static_cast<Real>(v)) {}  // NOLINT(google-explicit-constructor)
  explicit Dual(std::int64_t v) : value(static_cast<Real>(v)) {}
  explicit Dual(std::uint64_t v) : value(static_cast<Real>(v)) {}
  Dual(const Real& v, const Real& s) : value(v), slope(s) {}

  explicit operator double() const { return static_cast<double>(value); }
  explicit operator int() const { return static_cast<int>(value); }
  explicit operator std::int64_t() const { return static_cast<std::int64_t>(value); }

  friend Dual operator+(const Dual& a, const Dual& b) { return {a.value + b.value, a.slope + b.slope}; }
  friend Dual operator-(const Dual& a, const Dual& b) { return {a.value - b.value, a.slope - b.slope}; }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const Real ratio = a.value / b.value;
    return {ratio, (a.slope - ratio * b.slope) / b.value};
  }
  friend Dual operator-(const Dual& a) { return {-a.value, -a.slope}; }
  Dual& operator+=(const Dual& b) { return *this = *this + b; }
  Dual& operator-=(const Dual& b) { return *this = *this - b; }
  Dual& operator*=(const Dual& b) { return *this = *this * b; }
  Dual& operator/=(const Dual& b) { return *this = *this / b; }

  friend auto operator<=>(const Dual& a, const Dual& b) { return a.value <=> b.value; }
  friend bool operator==(const Dual& a, const Dual& b) { return a.value == b.value; }
};

/// Of zero the root has no slope; where edmill takes one, of a slip, what it is multiplied with is zero, too.
template <class Real>
Dual<Real> sqrt(const Dual<Real>& x) {
  using std::sqrt;
  const Real root = sqrt(x.value);
  return {root, root > 0 ? Real(x.slope / (2 * root)) : Real(0)};
}
template <class Real>
Dual<Real> abs(const Dual<Real>& x) {
  return x.value < 0 ? -x : x;
}
template <class Real>
Dual<Real> floor(const Dual<Real>& x) {
  using std::floor;
  return {floor(x.value)};
}
template <class Real>
Dual<Real> ldexp(const Dual<Real>& x, int exponent) {
  using std::ldexp;
  return {ldexp(x.value, exponent), ldexp(x.slope, exponent)};
}
template <class Real>
Dual<Real> frexp(const Dual<Real>& x, int* exponent) {
  using std::frexp;
  using std::ldexp;
  const Real fraction = frexp(x.value, exponent);
  return {fraction, ldexp(x.slope, -*exponent)};
}
template <class Real>
bool isfinite(const Dual<Real>& x) {
  using std::isfinite;
  return isfinite(x.value) && isfinite(x.slope);
}

}  // namespace edmill::tangent

/// The digits of the value.
template <class Real>
class std::numeric_limits<edmill::tangent::Dual<Real>> : public std::numeric_limits<Real> {};

template <class Real>
struct Eigen::NumTraits<edmill::tangent::Dual<Real>> : Eigen::GenericNumTraits<edmill::tangent::Dual<Real>> {
};

template <class Real>
struct edmill::numerics::Trigonometry<edmill::tangent::Dual<Real>> {
  using Dual = tangent::Dual<Real>;
  static Dual pi() { return {numerics::pi<Real>()}; }
  static SinCos<Dual> sin_cos(const Dual& angle) {
    const auto v = numerics::sin_cos<Real>(angle.value);
    return {{v.sin, v.cos * angle.slope}, {v.cos, -v.sin * angle.slope}};
  }
};
