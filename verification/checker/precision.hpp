// How many bits the arithmetic has.
#pragma once

namespace checker {

using Bits = long;

/// They suffice for most inequalities, and cost less than the bits of a certificate.
constexpr Bits few_bits = 128;

/// Bits of the arithmetic beyond those of a certificate, and the most that a certificate may have.
/// Whoever rounds in another way than Arb, with which certificates are made, needs more of them to
/// find enclosures that lie within those of the file.
#ifdef CHECKER_WITHOUT_ARB
constexpr Bits more_bits = 96,
               most_bits = 8192;  // integers are slow, and few terms of series have few errors
#else
constexpr Bits more_bits = 64, most_bits = 65536;
#endif

/// Bits of all arithmetic.
inline Bits precision = few_bits;

/// Sets the precision until the end of a block.
class WithPrecision {
 public:
  explicit WithPrecision(Bits bits) : before_(precision) { precision = bits; }
  WithPrecision(const WithPrecision&) = delete;
  WithPrecision& operator=(const WithPrecision&) = delete;
  ~WithPrecision() { precision = before_; }
 private:
  Bits before_;
};

}  // namespace checker
