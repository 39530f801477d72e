// When a mistake may be named, in one place. docs/audit.md, "What a log looks like"
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "audit/finding.hpp"

namespace edmill::audit {

/// A mistake explains a violation where the violation vanishes when the mistake is assumed: what is left is
/// within the tolerance, and at most a tenth of what was off. Within a coarse tolerance alone anything may
/// lie.
inline bool vanishes(double off, double left, double allowed) { return left <= allowed && 10 * left <= off; }

/// Nine tenths of a log, the rest of which may have another cause.
inline bool accounts_for(std::uint64_t explained, std::uint64_t of) {
  return explained > 0 && 10 * explained >= 9 * of;
}

/// A mistake while a log is read. It is named at the end of the log, where it accounts for the places at
/// which it would show and the evidence is strong; else what it seemed to explain is reported as it was
/// found.
class Suspicion {
 public:
  explicit Suspicion(std::size_t examples) : named_(examples), plain_(examples) {}

  /// A violation of size `off` vanishes with the mistake up to `left`. @return where to report it as such
  Findings& explains(double off, double left) {
    ++shows_, ++explained_;
    // A coincidence of one number within a tenth of its size happens in a tenth of all cases.
    decades_ += std::log10(off / std::max(left, 1e-17 * off));
    return named_;
  }
  /// Where to report the same violation without a name.
  Findings& plain() { return plain_; }
  /// The log has no sign of the mistake where it would show.
  void contradicted() { ++shows_; }

  bool is_suspected() const { return explained_ > 0; }
  bool is_named() const { return fits() && decades_ >= least_decades; }
  /// Nothing speaks against it, be there evidence or not.
  bool fits() const { return accounts_for(explained_, shows_); }
  const Findings& findings() const { return findings(is_named()); }
  const Findings& findings(bool named) const { return named ? named_ : plain_; }

 private:
  static constexpr double least_decades = 6;  ///< an exact log has more at a single impact
  Findings named_, plain_;
  std::uint64_t shows_ = 0, explained_ = 0;
  double decades_ = 0;
};

}  // namespace edmill::audit
