// Numbers and Taylor series with Arb's coefficients.
#pragma once

#include <arb.h>
#include <arb_poly.h>

#include <algorithm>
#include <utility>

namespace edmill::testing {

inline constexpr slong exact = ARF_PREC_EXACT;
inline constexpr slong coarse = 64;  // bits for ranges and remainders

/// Owner of one Arb ball.
struct Ball {
  arb_t v;
  Ball() { arb_init(v); }
  explicit Ball(double x) : Ball() { arb_set_d(v, x); }
  Ball(const Ball& other) : Ball() { arb_set(v, other.v); }
  Ball& operator=(const Ball& other) {
    arb_set(v, other.v);
    return *this;
  }
  ~Ball() { arb_clear(v); }
};

/// Owner of Taylor coefficients.
class Series {
 public:
  explicit Series(slong size = 0) : size_(size), data_(_arb_vec_init(size)) {}
  Series(const Series& other) : Series(other.size_) { _arb_vec_set(data_, other.data_, size_); }
  Series& operator=(Series other) {
    std::swap(size_, other.size_);
    std::swap(data_, other.data_);
    return *this;
  }
  ~Series() { _arb_vec_clear(data_, size_); }
  slong size() const { return size_; }
  arb_ptr operator[](slong k) const { return data_ + k; }

  Series derivative(slong prec) const {
    if (size_ <= 1) return Series(1);
    Series result(size_ - 1);
    _arb_poly_derivative(result.data_, data_, size_, prec);
    return result;
  }
  void at(Ball& result, const Ball& s, slong prec) const {
    _arb_poly_evaluate_horner(result.v, data_, size_, s.v, prec);
  }
 private:
  slong size_;
  arb_ptr data_;
};

inline Ball middle_of(const Ball& x) {
  Ball m;
  arb_get_mid_arb(m.v, x.v);
  return m;
}

inline Ball hull(const Ball& a, const Ball& b, slong prec) {
  Ball x;
  arb_union(x.v, a.v, b.v, prec);
  return x;
}

inline bool negative(const Ball& x) { return arb_is_negative(x.v); }
inline bool positive(const Ball& x) { return arb_is_positive(x.v); }
inline bool not_positive(const Ball& x) { return arb_is_nonpositive(x.v); }
inline bool not_negative(const Ball& x) { return arb_is_nonnegative(x.v); }
inline double nearest(const Ball& x) { return arf_get_d(arb_midref(x.v), ARF_RND_NEAR); }

/// Whether most of the width of `range` comes from the uncertainty of the value at its middle.
inline bool blurred(const Ball& at_middle, const Ball& range) {
  mag_t m;
  mag_init(m);
  mag_mul_2exp_si(m, arb_radref(at_middle.v), 3);
  const bool result = mag_cmp(m, arb_radref(range.v)) > 0;
  mag_clear(m);
  return result;
}

inline void sin_cos(const Series& angle, Series& sine, Series& cosine, slong prec) {
  const slong n = angle.size();
  Series rate(n);  // k a_k
  for (slong k = 1; k < n; ++k) arb_mul_ui(rate[k], angle[k], static_cast<ulong>(k), prec);
  arb_sin_cos(sine[0], cosine[0], angle[0], prec);
  for (slong k = 1; k < n; ++k) {
    arb_dot(sine[k], nullptr, 0, rate[1], 1, cosine[k - 1], -1, k, prec);
    arb_dot(cosine[k], nullptr, 1, rate[1], 1, sine[k - 1], -1, k, prec);
    arb_div_ui(sine[k], sine[k], static_cast<ulong>(k), prec);
    arb_div_ui(cosine[k], cosine[k], static_cast<ulong>(k), prec);
  }
}

}  // namespace edmill::testing
