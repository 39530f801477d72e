#include "tangent/spectrum.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/elementary.hpp"
#include "base/trigonometry.hpp"
#include "dynamics/impulse.hpp"

namespace edmill::tangent {

/// A dual number value + slope e with e^2 = 0, for forward-mode differentiation along one direction
/// of code that is a template of its scalar. Comparisons use the values, so that branches are those
/// of the motion itself.
struct Dual {
  double value = 0, slope = 0;

  Dual() = default;
  Dual(double v) : value(v) {}                    // NOLINT(google-explicit-constructor): a constant
  Dual(int v) : value(static_cast<double>(v)) {}  // NOLINT(google-explicit-constructor)
  explicit Dual(std::int64_t v) : value(static_cast<double>(v)) {}
  explicit Dual(std::uint64_t v) : value(static_cast<double>(v)) {}
  Dual(double v, double s) : value(v), slope(s) {}

  explicit operator double() const { return value; }
  explicit operator int() const { return static_cast<int>(value); }
  explicit operator std::int64_t() const { return static_cast<std::int64_t>(value); }

  friend Dual operator+(const Dual& a, const Dual& b) {
    return {a.value + b.value, a.slope + b.slope};
  }
  friend Dual operator-(const Dual& a, const Dual& b) {
    return {a.value - b.value, a.slope - b.slope};
  }
  friend Dual operator*(const Dual& a, const Dual& b) {
    return {a.value * b.value, a.slope * b.value + a.value * b.slope};
  }
  friend Dual operator/(const Dual& a, const Dual& b) {
    const double ratio = a.value / b.value;
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

/// The root has no derivative at zero, and the slope is 0 there. edmill takes it only for a slip,
/// whose factor is zero, too.
inline Dual sqrt(const Dual& x) {
  const double root = std::sqrt(x.value);
  return {root, root > 0 ? x.slope / (2 * root) : 0};
}
inline Dual abs(const Dual& x) { return x.value < 0 ? -x : x; }
inline Dual floor(const Dual& x) { return {std::floor(x.value)}; }
inline Dual ldexp(const Dual& x, int exponent) {
  return {std::ldexp(x.value, exponent), std::ldexp(x.slope, exponent)};
}
inline Dual frexp(const Dual& x, int* exponent) {
  const double fraction = std::frexp(x.value, exponent);
  return {fraction, std::ldexp(x.slope, -*exponent)};
}
inline bool isfinite(const Dual& x) { return std::isfinite(x.value) && std::isfinite(x.slope); }

}  // namespace edmill::tangent

/// The limits are those of the value.
template <>
class std::numeric_limits<edmill::tangent::Dual> : public std::numeric_limits<double> {};

template <>
struct Eigen::NumTraits<edmill::tangent::Dual> : Eigen::GenericNumTraits<edmill::tangent::Dual> {};

template <> struct edmill::numerics::Trigonometry<edmill::tangent::Dual> {
  using Dual = tangent::Dual;
  static Dual pi() { return {numerics::pi<double>()}; }
  static SinCos<Dual> sin_cos(const Dual& angle) {
    const auto v = numerics::sin_cos<double>(angle.value);
    return {{v.sin, v.cos * angle.slope}, {v.cos, -v.sin * angle.slope}};
  }
};

/// The value as text, for messages.
template <> std::string edmill::to_text<edmill::tangent::Dual>(const tangent::Dual& number) {
  return to_text(number.value);
}

namespace edmill::tangent {

namespace {

Vec3<Dual> with_slopes(const Vec3<double>& value, const Vec3<double>& slope) {
  return {Dual(value[0], slope[0]), Dual(value[1], slope[1]), Dual(value[2], slope[2])};
}
Vec3<double> slopes_of(const Vec3<Dual>& v) { return {v[0].slope, v[1].slope, v[2].slope}; }

/// Derivative of the time of an impact: how much later the neighbouring motion has it; zero for
/// bodies that do not approach each other.
double delay(const Vec3<double>& normal, const Vec3<double>& gap, double approach_speed) {
  return approach_speed > 0 ? dot<double>(normal, gap) / approach_speed : 0;
}

/// A body in the neighbouring motion.
struct Nearby {
  Vec3<Dual> position, velocity, spin;

  /// State at its own impact, `delay` after that of the run.
  Nearby(const Struck& body, const Tangent<double>& t, const Vec3<double>& gravity, double delay)
      : position(with_slopes(body.position, t.position + body.velocity * delay)),
        velocity(with_slopes(body.velocity, t.velocity + gravity * delay)),
        spin(with_slopes(body.spin, t.spin)) {}
  /// Derivative after its impact, taken back to the time of the run's impact.
  Tangent<double> back(const Struck& body, const Vec3<double>& gravity, double delay) const {
    return {slopes_of(position) - body.velocity_after * delay,
        slopes_of(velocity) - gravity * delay, slopes_of(spin)};
  }
};

/// The natural logarithm, with the same bits on every machine.
double logarithm(double x) {
  return x >= 1 ? numerics::log_of_one_plus<double>(x - 1)
                : -numerics::log_of_one_plus<double>(1 / x - 1);
}

/// Pseudo-random numbers for the initial directions, the same in every run (splitmix64). Any start
/// is suitable, since all directions turn towards those that grow.
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

struct TangentMap::InDuals {
  model::Mill<Dual> mill;
  std::vector<model::BallProperties<Dual>> balls;
  Vec3<double> gravity;
};

TangentMap::TangentMap(const model::Mill<double>& mill, const Balls& balls)
    : mill_(new InDuals{model::mill_cast<Dual>(mill), {}, mill.gravity}) {
  for (const auto& b : balls)
    mill_->balls.push_back({b.radius, b.mass, b.reduced_inertia, b.material});
}
TangentMap::~TangentMap() = default;

void TangentMap::with_wall(const ImpactAt& impact, int wall, const Struck& struck,
    std::span<Tangent<double>> directions) const {
  const auto& mill = mill_->mill;
  const auto& ball = mill_->balls[struck.ball];
  const auto& law = mill.law_with_wall(ball, wall);
  for (auto& direction : directions) {
    const double later = delay(impact.normal, direction.position, impact.approach_speed);
    Nearby body(struck, direction, mill_->gravity, later);
    const Instant<Dual> time{impact.time.period, Dual(impact.time.offset, later)};
    const auto touch = model::touch_of(mill, wall, ball.radius, time, body.position);
    dynamics::collide_with_wall<Dual>(
        touch.normal, ball, touch.wall_velocity, body.velocity, body.spin, law, impact.in_stall);
    direction = body.back(struck, mill_->gravity, later);
  }
}

void TangentMap::of_pair(const ImpactAt& impact, const Struck& one, const Struck& two,
    std::span<Tangent<double>> of_one, std::span<Tangent<double>> of_two) const {
  const auto &ball = mill_->balls[one.ball], &partner = mill_->balls[two.ball];
  const auto& law = mill_->mill.law_between(ball, partner);
  for (std::size_t k = 0; k < of_one.size(); ++k) {
    const double later =
        delay(impact.normal, of_one[k].position - of_two[k].position, impact.approach_speed);
    Nearby a(one, of_one[k], mill_->gravity, later), b(two, of_two[k], mill_->gravity, later);
    const Vec3<Dual> between = a.position - b.position;
    const Vec3<Dual> normal = between * (Dual(1) / norm<Dual>(between));
    dynamics::collide_balls<Dual>(
        normal, ball, partner, a.velocity, a.spin, b.velocity, b.spin, law, impact.in_stall);
    of_one[k] = a.back(one, mill_->gravity, later);
    of_two[k] = b.back(two, mill_->gravity, later);
  }
}

Spectrum::Spectrum(const model::Mill<double>& mill, const Balls& balls,
    const Instant<double>& start, std::size_t directions)
    : map_(mill, balls), clock_(mill.motion.period()), balls_(balls.size()),
      count_(std::min(directions, 9 * balls_)), length_(balls.at(0).radius),
      speed_(length_ / clock_.period()),
      spin_(1 / clock_.period()), state_{std::vector<Tangent<double>>(count_ * balls_),
                                      std::vector<Instant<double>>(balls_, start),
                                      std::vector<double>(count_, 0.0), 0,
                                      std::vector<std::int64_t>(balls_, 0)} {
  Mixer mixer;
  for (auto& t : state_.tangents)
    t = {mixer.vector(length_), mixer.vector(speed_), mixer.vector(spin_)};
  orthonormalise(start);
  state_.growth.assign(count_, 0.0);
}

void Spectrum::fly(int ball, const Instant<double>& now) {
  auto& since = state_.since[ball];
  const double dt = clock_.elapsed(since, now);
  for (auto& direction : of_ball(ball)) direction.fly(dt);
  since = now;
}

void Spectrum::with_wall(const ImpactAt& impact, int wall, const Struck& struck) {
  fly(struck.ball, impact.time);
  map_.with_wall(impact, wall, struck, of_ball(struck.ball));
  count_impact(impact.time, struck.ball, struck.ball);
}

void Spectrum::of_pair(const ImpactAt& impact, const Struck& one, const Struck& two) {
  fly(one.ball, impact.time);
  fly(two.ball, impact.time);
  map_.of_pair(impact, one, two, of_ball(one.ball), of_ball(two.ball));
  count_impact(impact.time, one.ball, two.ball);
}

/// Counts an impact and orthonormalises the directions before they lose their digits. All
/// directions approach the first one, by a factor of about e per collision of a ball, and those
/// that impacts damp shrink by the restitution. Sixteen digits suffice for many such collisions,
/// but not for a ball that hops.
void Spectrum::count_impact(const Instant<double>& now, int ball, int partner) {
  constexpr std::int64_t most_of_ball = 8;
  auto& of_one = ++state_.of_ball[ball];
  auto& of_other = state_.of_ball[partner];
  if (partner != ball) ++of_other;
  if (++state_.since_orthonormal >= balls_ || std::max(of_one, of_other) >= most_of_ball)
    orthonormalise(now);
}

double Spectrum::product(std::size_t a, std::size_t b) const {
  double r = 0, v = 0, w = 0;
  for (std::size_t ball = 0; ball < balls_; ++ball) {
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
  state_.of_ball.assign(balls_, 0);
  for (std::size_t ball = 0; ball < balls_; ++ball) fly(static_cast<int>(ball), now);
  const auto add = [this](std::size_t to, std::size_t from, double factor) {
    for (std::size_t ball = 0; ball < balls_; ++ball) {
      auto& t = state_.tangents[ball * count_ + to];
      const auto& f = state_.tangents[ball * count_ + from];
      t.position += f.position * factor;
      t.velocity += f.velocity * factor;
      t.spin += f.spin * factor;
    }
  };
  for (std::size_t k = 0; k < count_; ++k) {
    const double before_size = std::sqrt(product(k, k));
    for (int pass = 0; pass < 2; ++pass)  // the second one removes what rounding has left
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
