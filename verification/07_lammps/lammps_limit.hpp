// Dose rates of both codes, and those of LAMMPS in the limit of contacts of no duration.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "base/statistics.hpp"
#include "claim.hpp"
#include "core.hpp"
#include "lammps_mill.hpp"
#include "simulated.hpp"

namespace edmill::verification {

inline const Claim claim("07 LAMMPS");
inline const LammpsMotion spex{0.1, pi / 12, pi / 12, 60.0 / 1054, 9.8};

class LammpsPeer : public testing::Test {
 protected:
  void SetUp() override {
    if (!Lammps::present()) GTEST_SKIP() << "LAMMPS is absent: apt install lammps";
  }
};

/// Ratio of two means, and half the width of its 95 % interval.
inline std::pair<double, double> ratio(const std::vector<double>& a, const std::vector<double>& b) {
  const auto one = numerics::estimate(a), two = numerics::estimate(b);
  const double r = *one.mean / *two.mean;
  return {r, r * std::hypot(*one.half_width / *one.mean, *two.half_width / *two.mean)};
}

/// Dose rates of a run of edmill in batches of `batch` seconds, the first left out. [W]
inline std::vector<double> rates_of_run(const casefile::CaseSpec& spec,
    casefile::InitialCase<double>& initial, double batch, int batches) {
  struct Doses : engine::Observer<double> {
    std::vector<double> sums;
    double batch = 0;
    void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>& s) override {
      const auto k = static_cast<std::size_t>(s.seconds() / batch);
      if (k >= sums.size()) sums.resize(k + 1);
      sums[k] += impact.outcome.milling_dose;
    }
  } doses;
  doses.batch = batch;
  simulated(spec, initial, &doses);
  std::vector<double> rates;
  for (int i = 1; i <= batches; ++i)
    rates.push_back(doses.sums.at(static_cast<std::size_t>(i)) / batch);
  return rates;
}

inline std::string inverse(const std::vector<double>& rates) {
  const auto e = numerics::estimate(rates);
  return Claim::text(1 / *e.mean, 4) + " +- " +
      Claim::text(*e.half_width / (*e.mean * *e.mean), 2) + " s/J";
}

/// Line through values by weighted least squares, at zero: its value, and half of that value's
/// interval.
/// @param half  half widths of the values' intervals
inline std::pair<double, double> at_zero(
    const std::vector<double>& x, const std::vector<double>& y, const std::vector<double>& half) {
  double w = 0, wx = 0, wxx = 0, wy = 0, wxy = 0;
  for (std::size_t k = 0; k < x.size(); ++k) {
    const double weight = 1 / (half[k] * half[k]);
    w += weight, wx += weight * x[k], wxx += weight * x[k] * x[k];
    wy += weight * y[k], wxy += weight * x[k] * y[k];
  }
  const double determinant = w * wxx - wx * wx;
  return {(wxx * wy - wx * wxy) / determinant, std::sqrt(wxx / determinant)};
}

/// Softer and stiffer contacts: the dose rate of LAMMPS extrapolated to contacts that take no time,
/// as edmill's do.
/// @param lammps   rates of batches with contacts of a duration [s]
/// @param longest  of the durations [s]
inline void agree_in_the_limit(const Claim& claim, const std::string& name,
    const std::vector<double>& edmill, const std::function<std::vector<double>(double)>& lammps,
    double bound = 0.01, double longest = 100e-6) {
  claim.say(name + ", inverse dose rate: edmill " + inverse(edmill));
  std::vector<double> durations, rates, halves;
  for (const double duration : {longest, longest / 2, longest / 4}) {
    const auto found = lammps(duration);
    const auto estimate = numerics::estimate(found);
    durations.push_back(duration), rates.push_back(*estimate.mean),
        halves.push_back(*estimate.half_width);
    const auto [r, half] = ratio(found, edmill);
    claim.say(name + ", contacts of " + Claim::text(1e6 * duration) + " us: LAMMPS " +
        inverse(found) + ", over edmill " + Claim::text(r, 4) + " +- " + Claim::text(half, 2));
  }
  const auto [limit, half] = at_zero(durations, rates, halves);
  const auto peer = numerics::estimate(edmill);
  const double r = limit / *peer.mean,
               r_half = r * std::hypot(half / limit, *peer.half_width / *peer.mean);
  claim.at_most(name + ", contacts of no time: LAMMPS " + Claim::text(1 / limit, 4) + " +- " +
          Claim::text(half / (limit * limit), 2) + " s/J, over edmill " + Claim::text(r, 4) +
          " +- " + Claim::text(r_half, 2) + ", off one",
      std::abs(r - 1), bound);
  claim.at_most(name + ", half of the interval", r_half, bound / 2);
}

}  // namespace edmill::verification
