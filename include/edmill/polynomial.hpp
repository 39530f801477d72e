// Polynomials, for curved walls.
#pragma once

#include <array>
#include <concepts>
#include <cstddef>
#include <map>

namespace edmill {

/// A sum of terms c x^i y^j z^k r^l: x, y, z is the centre of a ball in the vessel frame and r its
/// radius [m].
template <class Real> class Polynomial {
 public:
  using Powers = std::array<int, 4>;  ///< of x, y, z, r

  template <std::convertible_to<Real> Number> Polynomial(const Number& constant) {
    terms_[Powers{}] = Real(constant);
  }
  static Polynomial x() { return Variable{0}; }
  static Polynomial y() { return Variable{1}; }
  static Polynomial z() { return Variable{2}; }
  static Polynomial r() { return Variable{3}; }

  const std::map<Powers, Real>& terms() const { return terms_; }

  friend Polynomial operator+(Polynomial a, const Polynomial& b) {
    for (const auto& [powers, factor] : b.terms_) a.add(powers, factor);
    return a;
  }
  friend Polynomial operator-(Polynomial a, const Polynomial& b) {
    for (const auto& [powers, factor] : b.terms_) a.add(powers, Real(-factor));
    return a;
  }
  friend Polynomial operator*(const Polynomial& a, const Polynomial& b) {
    Polynomial product(Real(0));
    for (const auto& [p, one] : a.terms_)
      for (const auto& [q, other] : b.terms_)
        product.add({p[0] + q[0], p[1] + q[1], p[2] + q[2], p[3] + q[3]}, Real(one * other));
    return product;
  }
 private:
  struct Variable {
    std::size_t place;
  };
  Polynomial(Variable v) {
    Powers powers{};
    powers[v.place] = 1;
    terms_[powers] = Real(1);
  }
  void add(const Powers& powers, const Real& factor) {
    const auto found = terms_.emplace(powers, Real(0)).first;
    found->second = found->second + factor;
  }

  std::map<Powers, Real> terms_;
};

}  // namespace edmill
