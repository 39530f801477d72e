// A scalar of MPFR whose digits are chosen at run time.
#pragma once

#include <gmp.h>
#include <mpfr.h>

#include <algorithm>
#include <compare>
#include <iterator>
#include <limits>
#include <ostream>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>

namespace edmill {

/// Conversions of a number type of another library: `exact` converts to `mpfr` without rounding,
/// `rounded` converts back and rounds.
template <class Number> struct MpfrConversion {};

/// An MPFR floating-point number. Every operation rounds to nearest, to the precision that the
/// current thread has set with `mpfr::Digits` (default: 50 decimal digits). Stored and copied
/// numbers, and those converted from a narrower type, keep all their bits. Significands of up to
/// 384 bits are part of the object, longer ones are allocated.
class mpfr {
 public:
  /// Sets the precision of the current thread until the end of the scope.
  class Digits {
   public:
    /// @param shown  digits written to files (default: enough to read the same number back)
    explicit Digits(unsigned decimal, unsigned shown = 0) : before_(chosen()) {
      const mpfr_prec_t bits = bits_of(decimal);
      chosen() = {decimal, shown > 0 ? shown : shown_of(bits), bits};
    }
    ~Digits() { chosen() = before_; }
    Digits(const Digits&) = delete;
    Digits& operator=(const Digits&) = delete;
   private:
    friend class mpfr;
    struct Chosen {
      unsigned decimal, shown;
      mpfr_prec_t bits;
    };
    /// Bits for this many decimal digits, the same as in scalars of fixed precision such as mpfr50.
    static constexpr mpfr_prec_t bits_of(unsigned decimal) {
      const long long thousand = 1000LL * decimal;
      return static_cast<mpfr_prec_t>(thousand / 301 + (thousand % 301 != 0 ? 2 : 1));
    }
    static constexpr unsigned shown_of(mpfr_prec_t bits) {
      return static_cast<unsigned>(static_cast<double>(bits) * 0.30103) + 2;
    }
    static Chosen& chosen() {
      static constinit thread_local Chosen now{50, shown_of(bits_of(50)), bits_of(50)};
      return now;
    }
    Chosen before_;
  };
  /// Decimal digits of the thread's results.
  static unsigned digits() { return Digits::chosen().decimal; }
  /// Decimal digits of a number in files and texts.
  static unsigned shown() { return Digits::chosen().shown; }
  /// Bits of the thread's results.
  static mpfr_prec_t bits() { return Digits::chosen().bits; }

  mpfr() : mpfr(0) {}
  template <class T>
  requires std::is_arithmetic_v<T> mpfr(
      T value) {  // NOLINT(google-explicit-constructor): exact, as from int to double
    if constexpr (std::is_floating_point_v<T>) {
      make(53);
      mpfr_set_d(n_, static_cast<double>(value), MPFR_RNDN);
    } else {
      make(64);
      if constexpr (std::is_signed_v<T>)
        mpfr_set_si(n_, value, MPFR_RNDN);
      else
        mpfr_set_ui(n_, value, MPFR_RNDN);
    }
  }
  /// @throws std::runtime_error when the text is not a number
  explicit mpfr(const std::string& text) {
    make(bits());
    if (mpfr_set_str(n_, text.c_str(), 10, MPFR_RNDN) == 0) return;
    drop();
    throw std::runtime_error("not a number: '" + text + "'");
  }
  explicit mpfr(mpfr_srcptr number) {
    make(mpfr_get_prec(number));
    mpfr_set(n_, number, MPFR_RNDN);
  }
  template <class Number>
  requires requires(const Number& x) { MpfrConversion<Number>::exact(x); }
  explicit mpfr(const Number& number) : mpfr(MpfrConversion<Number>::exact(number)) {}
  mpfr(const mpfr& o) {
    if (o.is_inside()) {
      take_inside(o);
    } else {
      make(mpfr_get_prec(o.n_));
      mpfr_set(n_, o.n_, MPFR_RNDN);
    }
  }
  mpfr(mpfr&& o) noexcept {
    n_[0]._mpfr_d = nullptr;
    take(o);
  }
  ~mpfr() { drop(); }
  mpfr& operator=(const mpfr& o) {
    if (this == &o) return *this;
    if (o.is_inside()) {
      drop();
      take_inside(o);
    } else {
      set_precision(mpfr_get_prec(o.n_));
      mpfr_set(n_, o.n_, MPFR_RNDN);
    }
    return *this;
  }
  mpfr& operator=(mpfr&& o) noexcept {
    if (this != &o) take(o);
    return *this;
  }

  mpfr_ptr data() { return n_; }
  mpfr_srcptr data() const { return n_; }
  /// Prepares the number for a result that a function of MPFR will store in it; its value is lost.
  void set_precision(mpfr_prec_t bits) {
    if (n_[0]._mpfr_d && mpfr_get_prec(n_) == bits) return;
    drop();
    make(bits);
  }
  /// A copy rounded to the precision of the current thread.
  mpfr rounded() const { return of(mpfr_set, data()); }
  /// Decimal text with `digits` significant digits, in the format of printf's %g (default: enough
  /// to read the same number back).
  std::string str(int digits = 0, bool scientific = false) const {
    if (digits == 0)
      digits = static_cast<int>(static_cast<double>(mpfr_get_prec(n_)) * 0.30103) + 2;
    const char* format = scientific ? "%.*Re" : "%.*Rg";
    const int places = scientific ? digits - 1 : digits;
    std::string text(static_cast<std::size_t>(mpfr_snprintf(nullptr, 0, format, places, n_)), '\0');
    mpfr_snprintf(text.data(), text.size() + 1, format, places, n_);
    return text;
  }

  template <class T>
  requires std::is_arithmetic_v<T>
  explicit operator T() const {
    if constexpr (std::is_same_v<T, bool>)
      return !mpfr_zero_p(n_);
    else if constexpr (std::is_floating_point_v<T>)
      return static_cast<T>(mpfr_get_d(n_, MPFR_RNDN));
    else if constexpr (std::is_signed_v<T>)
      return static_cast<T>(mpfr_get_si(n_, MPFR_RNDZ));
    else
      return static_cast<T>(mpfr_get_ui(n_, MPFR_RNDZ));
  }

  template <class Number>
  requires requires(const mpfr& x) { MpfrConversion<Number>::rounded(x); }
  explicit operator Number() const { return MpfrConversion<Number>::rounded(*this); }

  /// Calls one of MPFR's functions with a result in the precision of the current thread.
  template <class Function, class... Arguments>
  static mpfr of(const Function& function, const Arguments&... arguments) {
    mpfr result((Unset()));
    function(result.n_, arguments..., MPFR_RNDN);
    return result;
  }

  friend mpfr operator+(const mpfr& a, const mpfr& b) { return of(mpfr_add, a.data(), b.data()); }
  friend mpfr operator-(const mpfr& a, const mpfr& b) { return of(mpfr_sub, a.data(), b.data()); }
  friend mpfr operator*(const mpfr& a, const mpfr& b) { return of(mpfr_mul, a.data(), b.data()); }
  friend mpfr operator/(const mpfr& a, const mpfr& b) { return of(mpfr_div, a.data(), b.data()); }
  friend mpfr operator-(const mpfr& a) { return of(mpfr_neg, a.data()); }
  friend mpfr operator+(const mpfr& a) { return a; }
  mpfr& operator+=(const mpfr& b) { return into(mpfr_add, b); }
  mpfr& operator-=(const mpfr& b) { return into(mpfr_sub, b); }
  mpfr& operator*=(const mpfr& b) { return into(mpfr_mul, b); }
  mpfr& operator/=(const mpfr& b) { return into(mpfr_div, b); }

  friend std::partial_ordering operator<=>(const mpfr& a, const mpfr& b) {
    if (mpfr_unordered_p(a.n_, b.n_)) return std::partial_ordering::unordered;
    return mpfr_cmp(a.n_, b.n_) <=> 0;
  }
  friend std::ostream& operator<<(std::ostream& out, const mpfr& x) {
    const bool scientific = (out.flags() & std::ios_base::scientific) != 0;
    return out << x.str(static_cast<int>(out.precision()) + (scientific ? 1 : 0), scientific);
  }
  friend bool operator==(const mpfr& a, const mpfr& b) { return mpfr_equal_p(a.n_, b.n_) != 0; }
 private:
  static constexpr mpfr_prec_t most_inside = 384;  ///< bits

  struct Unset {};
  explicit mpfr(Unset) { make(bits()); }
  template <class Function> mpfr& into(const Function& function, const mpfr& b) {
    if (mpfr_get_prec(n_) == bits())
      function(n_, n_, b.n_, MPFR_RNDN);
    else
      *this = of(function, data(), b.data());
    return *this;
  }

  bool is_inside() const { return n_[0]._mpfr_d == inside_; }
  void make(mpfr_prec_t bits) {
    if (bits <= most_inside)
      mpfr_custom_init_set(n_, MPFR_NAN_KIND, 0, bits, inside_);
    else
      mpfr_init2(n_, bits);
  }
  void drop() {
    if (n_[0]._mpfr_d && !is_inside()) mpfr_clear(n_);
  }
  void take_inside(const mpfr& o) {
    n_[0] = o.n_[0];
    n_[0]._mpfr_d = inside_;
    std::copy(std::begin(o.inside_), std::end(o.inside_), inside_);
  }
  void take(mpfr& o) {
    drop();
    if (o.is_inside()) return take_inside(o);
    n_[0] = o.n_[0];
    o.n_[0]._mpfr_d = nullptr;
  }

  mpfr_t n_;
  mp_limb_t inside_[most_inside /
      GMP_NUMB_BITS];  ///< left uninitialised, like a variable of arithmetic type
};

inline mpfr abs(const mpfr& x) { return mpfr::of(mpfr_abs, x.data()); }
inline mpfr fabs(const mpfr& x) { return abs(x); }
inline mpfr sqrt(const mpfr& x) { return mpfr::of(mpfr_sqrt, x.data()); }
inline mpfr exp(const mpfr& x) { return mpfr::of(mpfr_exp, x.data()); }
inline mpfr log(const mpfr& x) { return mpfr::of(mpfr_log, x.data()); }
inline mpfr log10(const mpfr& x) { return mpfr::of(mpfr_log10, x.data()); }
inline mpfr log1p(const mpfr& x) { return mpfr::of(mpfr_log1p, x.data()); }
inline mpfr sin(const mpfr& x) { return mpfr::of(mpfr_sin, x.data()); }
inline mpfr cos(const mpfr& x) { return mpfr::of(mpfr_cos, x.data()); }
inline mpfr atan2(const mpfr& y, const mpfr& x) { return mpfr::of(mpfr_atan2, y.data(), x.data()); }
inline mpfr pow(const mpfr& x, const mpfr& y) { return mpfr::of(mpfr_pow, x.data(), y.data()); }
inline mpfr floor(const mpfr& x) { return mpfr::of(mpfr_rint_floor, x.data()); }
inline mpfr round(const mpfr& x) { return mpfr::of(mpfr_rint_round, x.data()); }
inline mpfr ldexp(const mpfr& x, int exponent) {
  return mpfr::of(mpfr_mul_2si, x.data(), long{exponent});
}
inline mpfr frexp(const mpfr& x, int* exponent) {
  mpfr_exp_t e = 0;
  mpfr result;
  result.set_precision(mpfr_get_prec(x.data()));
  mpfr_frexp(&e, result.data(), x.data(), MPFR_RNDN);
  *exponent = static_cast<int>(e);
  return result;
}
/// The exponent e with 2^(e-1) <= |x| < 2^e. @pre x is not zero
inline long exponent_of(const mpfr& x) { return mpfr_get_exp(x.data()); }
inline bool isfinite(const mpfr& x) { return mpfr_number_p(x.data()) != 0; }
inline bool isinf(const mpfr& x) { return mpfr_inf_p(x.data()) != 0; }
inline bool signbit(const mpfr& x) { return mpfr_signbit(x.data()) != 0; }
inline bool isnan(const mpfr& x) { return mpfr_nan_p(x.data()) != 0; }

}  // namespace edmill

/// The number of digits is not a constant and is left at its default; use `mpfr::bits`.
template <>
class std::numeric_limits<edmill::mpfr> : public std::numeric_limits<edmill::mpfr::Digits> {
 public:
  static constexpr bool is_signed = true, has_infinity = true, has_quiet_NaN = true;
  static edmill::mpfr infinity() { return std::numeric_limits<double>::infinity(); }
  static edmill::mpfr quiet_NaN() { return std::numeric_limits<double>::quiet_NaN(); }
};
