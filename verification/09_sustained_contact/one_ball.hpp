// What the programs of claim 09 share: one ball on one wall, orders of convergence, the bound on
// impacts.
#pragma once

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "claim.hpp"
#include "core.hpp"

namespace edmill::verification {

inline const Claim sustained("09 sustained contact");

/// The fewest digits that are read back into the double.
inline std::string digits(double v) { return fmt::format("{}", v); }
/// The number that a case with these digits has, in every scalar.
inline exact decimal(double v) { return exact(digits(v)); }

/// A vector as the value of a key; 40 digits are enough for float128 too.
inline std::string vector_text(const exact& x, const exact& y, const exact& z) {
  return "[\"" + x.str(40) + "\", \"" + y.str(40) + "\", \"" + z.str(40) + "\"]\n";
}

/// The contact law of a case; e is low, so that an approach near v_s is left at v_s.
struct Law {
  double least_separation;  ///< v_s [m/s]
  double friction;
  double min_tangential = 0;
  double restitution = 0.5;

  std::string text() const {
    return "[contact]\nrestitution = " + digits(restitution) + "\nfriction = " + digits(friction) +
        "\nmin_tangential = " + digits(min_tangential) + "\nleast_separation = \"" +
        digits(least_separation) + " m/s\"\n";
  }
};

/// A run of one ball that touches one wall and no other; counts impacts against the bound a/(2
/// v_s).
template <class Real> class OneBall : engine::Observer<Real> {
 public:
  using Impact = engine::Impact<Real>;

  /// @param fastest  no acceleration [m/s2] of the ball to the wall along the normal is greater
  OneBall(const std::string& text, int wall, double fastest)
      : built_(casefile::build_case<Real>(casefile::parse_case(text, "sustained_contact.toml"))),
        simulation_(built_.the_case, built_.states, built_.start), wall_(wall), fastest_(fastest) {
    simulation_.attach(*this);
  }

  std::function<void(const Impact&)> watch;  ///< told of every impact
  Real dose{0}, supplied{0};                 ///< [J]

  /// Runs on to `time` [s] and gives the ball's state there.
  model::BallState<Real> at(const Real& time) {
    const auto when = simulation_.clock().at(time);
    EXPECT_EQ(simulation_.run_until(when), engine::EndReason::end_time);
    return simulation_.state_at(0, when);
  }

  const engine::Simulation<Real>& simulation() const { return simulation_; }
  const model::BallProperties<Real>& ball() const { return simulation_.properties(0); }
  Real seconds(const Impact& impact) const { return simulation_.clock().seconds(impact.time); }
  std::uint64_t impacts() const { return impacts_; }
  /// The shortest flight between two impacts over 2 v_s/a.
  double shortest_flight() const { return shortest_ * fastest_ / (2 * v_s()); }
  /// Impacts over the most that a/(2 v_s) + 1 allows.
  double share_of_bound() const {
    const double most = static_cast<double>(simulation_.seconds()) * fastest_ / (2 * v_s()) + 1;
    return static_cast<double>(impacts_) / std::floor(most);
  }
 private:
  double v_s() const { return static_cast<double>(simulation_.mill().ball_wall.least_separation); }

  void on_impact(const Impact& impact, engine::Simulation<Real>&) override {
    EXPECT_TRUE(impact.with_wall && impact.partner == wall_) << "another wall is touched";
    if (impacts_++ > 0) shortest_ = std::min(shortest_, static_cast<double>(impact.flight_time[0]));
    dose += impact.outcome.milling_dose;
    supplied += impact.outcome.supplied_energy;
    if (watch) watch(impact);
  }

  casefile::InitialCase<Real> built_;
  engine::Simulation<Real> simulation_;
  int wall_;
  double fastest_, shortest_ = 1e300;
  std::uint64_t impacts_ = 0;
};

/// Errors at several v_s, and the order that they show.
class Convergence {
 public:
  explicit Convergence(std::string name) : name_(std::move(name)) {}

  void add(double v_s, double error) {
    log_v_s_.push_back(std::log(v_s)), errors_.push_back(error);
  }

  /// Slope of the least-squares line through log(error) over log(v_s).
  double order() const {
    const auto n = static_cast<double>(errors_.size());
    double x = 0, y = 0, xx = 0, xy = 0;
    for (std::size_t k = 0; k < errors_.size(); ++k) {
      const double a = log_v_s_[k], b = std::log(errors_[k]);
      x += a, y += b, xx += a * a, xy += a * b;
    }
    return (n * xy - x * y) / (n * xx - x * x);
  }

  void expect_order(double expected, double tolerance) const {
    EXPECT_GE(errors_.size(), 3u);
    std::string line = name_ + ", v_s to error:";
    for (std::size_t k = 0; k < errors_.size(); ++k)
      line += " " + Claim::text(std::exp(log_v_s_[k])) + " " + Claim::text(errors_[k]) + ";";
    sustained.say(line);
    const double found = order();
    sustained.at_most(name_ + ", order " + Claim::text(found) + ", off " + Claim::text(expected),
        std::abs(found - expected), tolerance);
  }

  /// @param tolerance  relative, of the error over v_s at the least v_s
  void expect_factor(double expected, double tolerance) const {
    const double found = errors_.back() / std::exp(log_v_s_.back());
    sustained.at_most(name_ + ", error over v_s " + Claim::text(found, 5) + " s/m, relative to " +
            Claim::text(expected, 5) + " off by",
        std::abs(found / expected - 1), tolerance);
  }
 private:
  std::string name_;
  std::vector<double> log_v_s_, errors_;
};

/// The bound on the number of impacts, over several runs.
struct ImpactBound {
  double shortest = 1e300, share = 0;
  std::uint64_t impacts = 0;

  template <class Real> void add(const OneBall<Real>& run) {
    shortest = std::min(shortest, run.shortest_flight());
    raise(share, run.share_of_bound());
    impacts += run.impacts();
  }
  /// @param rounding  by which the times of impact may shorten a flight, as a share of 2 v_s/a
  void expect(const std::string& name, double rounding) const {
    sustained.at_most(
        name + ", " + std::to_string(impacts) + " impacts, largest share of a t/(2 v_s) + 1", share,
        1);
    sustained.at_most(name + ", shortest flight below 2 v_s/a by", 1 - shortest, rounding);
  }
};

}  // namespace edmill::verification
