#include "tangent/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/elementary.hpp"
#include "base/errors.hpp"

namespace edmill::tangent {

namespace {

/// With the same bits on every machine.
double logarithm(double x) {
  return x >= 1 ? numerics::log_of_one_plus<double>(x - 1) : -numerics::log_of_one_plus<double>(1 / x - 1);
}

/// Any start does: directions turn to where they grow. Equal numbers in every run (splitmix64).
class Mixer {
 public:
  double next() {
    state_ += 0x9e37'79b9'7f4a'7c15;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58'476d'1ce4'e5b9;
    z = (z ^ (z >> 27)) * 0x94d0'49bb'1331'11eb;
    return static_cast<double>((z ^ (z >> 31)) >> 11) * 0x1p-52 - 1;
  }
  Vec3<double> vector(double size) {
    const double x = next(), y = next(), z = next();
    return Vec3<double>(x, y, z) * size;
  }

 private:
  std::uint64_t state_ = 1;
};

}  // namespace

Spectrum::Spectrum(const model::Mill<double>& mill, Balls balls, const Instant<double>& start,
                   std::size_t directions)
    : map_(mill),
      balls_(std::move(balls)),
      clock_(mill.motion.period()),
      count_(std::min(directions, 9 * balls_.size())),
      length_(balls_.at(0).radius),
      speed_(length_ / clock_.period()),
      spin_(1 / clock_.period()),
      state_{std::vector<Tangent<double>>(count_ * balls_.size()),
             std::vector<Instant<double>>(balls_.size(), start), std::vector<double>(count_, 0.0), 0,
             std::vector<std::int64_t>(balls_.size(), 0)} {
  Mixer mixer;
  for (auto& t : state_.tangents) t = {mixer.vector(length_), mixer.vector(speed_), mixer.vector(spin_)};
  orthonormalise(start);
  state_.growth.assign(count_, 0.0);
}

void Spectrum::fly(int ball, const Instant<double>& now) {
  auto& since = state_.since[static_cast<std::size_t>(ball)];
  const double dt = clock_.elapsed(since, now);
  for (auto& direction : of_ball(ball)) direction.fly(dt);
  since = now;
}

void Spectrum::with_wall(const ImpactAt<double>& impact, int wall, const Body& body) {
  fly(body.ball, impact.time);
  map_.with_wall(impact, wall,
                 {balls_[static_cast<std::size_t>(body.ball)], body.position, body.velocity, body.spin,
                  body.velocity_after},
                 of_ball(body.ball));
  count_impact(impact.time, body.ball, body.ball);
}

void Spectrum::of_pair(const ImpactAt<double>& impact, const Body& one, const Body& two) {
  fly(one.ball, impact.time);
  fly(two.ball, impact.time);
  const auto struck = [this](const Body& b) {
    return Struck<double>{balls_[static_cast<std::size_t>(b.ball)], b.position, b.velocity, b.spin,
                          b.velocity_after};
  };
  map_.of_pair(impact, struck(one), struck(two), of_ball(one.ball), of_ball(two.ball));
  count_impact(impact.time, one.ball, two.ball);
}

/// Directions turn into the first one by a factor of about e per collision of a ball, and those that impacts
/// take away shrink by the restitution: sixteen digits last for many, but not for a ball that hops.
void Spectrum::count_impact(const Instant<double>& now, int ball, int partner) {
  constexpr std::int64_t most_of_ball = 8;
  auto& of_one = ++state_.of_ball[static_cast<std::size_t>(ball)];
  auto& of_other = state_.of_ball[static_cast<std::size_t>(partner)];
  if (partner != ball) ++of_other;
  if (++state_.since_orthonormal >= balls_.size() || std::max(of_one, of_other) >= most_of_ball)
    orthonormalise(now);
}

double Spectrum::product(std::size_t a, std::size_t b) const {
  double r = 0, v = 0, w = 0;
  for (std::size_t ball = 0; ball < balls_.size(); ++ball) {
    const auto &one = state_.tangents[ball * count_ + a], &two = state_.tangents[ball * count_ + b];
    r += dot<double>(one.position, two.position);
    v += dot<double>(one.velocity, two.velocity);
    w += dot<double>(one.spin, two.spin);
  }
  return r / (length_ * length_) + v / (speed_ * speed_) + w / (spin_ * spin_);
}

void Spectrum::orthonormalise(const Instant<double>& now) {
  constexpr double rounding = 1e-13;  // of a sum of many numbers, relative to the largest
  state_.since_orthonormal = 0;
  state_.of_ball.assign(balls_.size(), 0);
  for (std::size_t ball = 0; ball < balls_.size(); ++ball) fly(static_cast<int>(ball), now);
  const auto add = [this](std::size_t to, std::size_t from, double factor) {
    for (std::size_t ball = 0; ball < balls_.size(); ++ball) {
      auto& t = state_.tangents[ball * count_ + to];
      const auto& f = state_.tangents[ball * count_ + from];
      t.position += f.position * factor, t.velocity += f.velocity * factor, t.spin += f.spin * factor;
    }
  };
  for (std::size_t k = 0; k < count_; ++k) {
    const double before_size = std::sqrt(product(k, k));
    for (int pass = 0; pass < 2; ++pass)  // the second one takes off what rounding has left
      for (std::size_t before = 0; before < k; ++before) add(k, before, -product(k, before));
    const double size = std::sqrt(product(k, k));
    if (!(size > rounding * before_size)) {  // nothing is left of it
      state_.growth[k] = -std::numeric_limits<double>::infinity();
      add(k, k, -1);
      continue;
    }
    state_.growth[k] += logarithm(size);
    add(k, k, 1 / size - 1);
  }
}

}  // namespace edmill::tangent
