// Random numbers with specified bits: the same on every machine and in every scalar.
#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>

namespace edmill::casefile {

class Random {
 public:
  explicit Random(std::uint64_t seed) : engine_(seed) {}

  /// Uniform in [0, 1): a multiple of 2^-53, exact in every scalar.
  template <class Real> Real uniform() {
    return Real(static_cast<std::int64_t>(engine_() >> 11)) / Real(std::int64_t{1} << 53);
  }
  /// Uniform in [-1, 1).
  template <class Real> Real symmetric() { return 2 * uniform<Real>() - 1; }
 private:
  boost::random::mt19937_64 engine_;
};

}  // namespace edmill::casefile
