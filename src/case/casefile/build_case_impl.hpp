// Quantity::to and build_case: from exact quantities to one scalar, and balls by given states, at
// random places, and in crowds that are pushed apart. Included by the instantiation files only.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <boost/unordered/unordered_flat_map.hpp>
#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/dyadic.hpp"
#include "base/errors.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case.hpp"
#include "casefile/random.hpp"
#include "casefile/rational.hpp"
#include "io/final_state.hpp"

namespace edmill::casefile {

namespace detail {

/// The nearest value of a scalar type, ties to even.
template <class Real> Real nearest(const Rational& value) {
  using boost::multiprecision::cpp_int;
  const cpp_int above = abs(numerator(value)), below = denominator(value);
  if (above == 0) return Real(0);
  const auto digits = static_cast<unsigned>(binary_digits<Real>());
  // The quotient has one or two spare bits; a last bit says whether there is a remainder.
  int exponent =
      static_cast<int>(msb(above)) - static_cast<int>(msb(below)) - static_cast<int>(digits) - 1;
  cpp_int quotient, remainder;
  divide_qr(exponent < 0 ? cpp_int(above << -exponent) : above,
      exponent > 0 ? cpp_int(below << exponent) : below, quotient, remainder);
  quotient = (quotient << 1) | (remainder != 0 ? 1 : 0);
  const unsigned spare = static_cast<unsigned>(msb(quotient)) + 1 - digits;
  const cpp_int half = cpp_int(1) << (spare - 1), rest = quotient & (2 * half - 1);
  quotient >>= spare;
  if (rest > half || (rest == half && bit_test(quotient, 0))) ++quotient;
  return Dyadic(value < 0 ? cpp_int(-quotient) : quotient, exponent - 1 + static_cast<int>(spare))
      .to<Real>();
}

/// Bits to which pi is computed, so that only the last rounding matters.
template <class Real> int bits_for() { return 2 * binary_digits<Real>() + 64; }

}  // namespace detail

template <class Real> Real Quantity::to() const {
  return detail::nearest<Real>(value_of(*this, detail::bits_for<Real>()));
}

/// The instant at `time`, reduced exactly: the offset is as sharp at 1e6 s as at the start.
/// @param time  not negative @param period  of the drive
template <class Real> Instant<Real> instant_at(const Quantity& time, const Quantity& period) {
  if (time.zero()) return {};
  const int bits = detail::bits_for<Real>() + 64;  // enough for the largest number of periods
  const Rational seconds = value_of(time, bits), length = value_of(period, bits),
                 count = seconds / length;
  const auto periods = static_cast<std::int64_t>(
      boost::multiprecision::cpp_int(numerator(count) / denominator(count)));
  const auto offset = detail::nearest<Real>(seconds - periods * length);
  if (offset < period.to<Real>()) return {periods, offset};
  return {periods + 1, Real(0)};  // it is rounded to a whole period
}

namespace detail {

template <class Real> Vec3<Real> to_vector(const QuantityVector& q) {
  return {q[0].to<Real>(), q[1].to<Real>(), q[2].to<Real>()};
}

template <class Real>
model::BallProperties<Real> to_ball(const BallSpec& spec, const Real& diameter) {
  const Real radius = diameter / 2;
  const Real volume = 4 * numerics::pi<Real>() * (radius * radius * radius) / 3;
  return {radius, spec.density.to<Real>() * volume, spec.reduced_inertia.to<Real>(), spec.material};
}

/// Placed balls in the vessel frame, in cells as wide as the largest distance to be tested.
template <class Real> class PlacedBalls {
 public:
  explicit PlacedBalls(double cell) : cell_(cell) {}

  void add(int index, const Vec3<Real>& p) { cells_[key(p, 0, 0, 0)].emplace_back(index, p); }

  /// A ball closer to `p` than `least(index)`, or -1.
  int conflict(const Vec3<Real>& p, const auto& least) const {
    for (const int x : {-1, 0, 1})
      for (const int y : {-1, 0, 1})
        for (const int z : {-1, 0, 1}) {
          const auto found = cells_.find(key(p, x, y, z));
          if (found == cells_.end()) continue;
          for (const auto& [index, position] : found->second) {
            const Vec3<Real> between = p - position;
            const Real distance = least(index);
            if (dot<Real>(between, between) < distance * distance) return index;
          }
        }
    return -1;
  }
 private:
  using Key = std::array<double, 3>;  // whole numbers of any size
  Key key(const Vec3<Real>& p, int dx, int dy, int dz) const {
    const auto cell = [&](const Real& c) { return std::floor(static_cast<double>(c) / cell_); };
    return {cell(p[0]) + dx, cell(p[1]) + dy, cell(p[2]) + dz};
  }
  double cell_;
  boost::unordered_flat_map<Key, std::vector<std::pair<int, Vec3<Real>>>> cells_;
};

/// A ball of a crowd. Places are double in runs of every scalar, so that all start from the same.
struct CrowdBall {
  double radius;                      ///< [m]
  double gap_ball = 0, gap_wall = 0;  ///< to balls before it and to walls [m]
  Vec3<double> place;                 ///< of the centre, vessel frame [m]
  bool fixed = false;                 ///< stays where it is
};

/// A body and its frame in that of the vessel, at the start.
struct CrowdBody {
  Frame<double> frame;
  model::RoundedBody<double> shape;
};

/// Balls that may overlap are moved apart until none is closer to another or to a wall than `share`
/// of its gaps. The moves are projections: each pair that is too close is parted along the line of
/// its centres, each ball beyond a wall goes back along the normal.
class Crowd {
  using Place = Vec3<double>;
 public:
  /// @param moved  inward displacement of each wall, for pistons; empty if there are none [m]
  Crowd(const model::AnyVessel<double>& vessel, const std::vector<double>& moved,
      const std::vector<CrowdBody>& bodies, std::vector<CrowdBall>& balls, double share)
      : vessel_(vessel), moved_(moved), bodies_(bodies), balls_(balls), share_(share) {
    for (const auto& ball : balls_) {
      const double distance = distance_from_walls(ball);
      if (!rooms_.contains(distance)) rooms_.emplace(distance, vessel_.inset(distance));
      widest_ = std::max(widest_, 2 * ball.radius + share * ball.gap_ball);
      slimmest_ = std::min(slimmest_, ball.radius);
    }
  }

  /// @return false if they are too close after as many sweeps as their number allows
  bool push_apart() {
    for (const auto& [distance, room] : rooms_)
      if (room.is_empty()) return false;
    const auto most = std::clamp<std::size_t>(2000000 / balls_.size(), 200, 4000);
    for (std::size_t k = 0; k < most; ++k)
      if (sweep()) return true;
    return false;
  }
 private:
  /// Parts all pairs and brings all balls inside, once. @return true if nothing had to be moved
  bool sweep() {
    if (have_gone_far()) find_pairs();
    bool apart = true;
    for (const auto& [one, other] : pairs_) apart &= part(one, other);
    for (std::size_t k = 0; k < balls_.size(); ++k)
      if (!balls_[k].fixed) apart &= bring_inside(k);
    return apart;
  }
  double skin() const { return slimmest_ / 2; }
  /// Least distance of the centre from the walls [m].
  double distance_from_walls(const CrowdBall& ball) const {
    return ball.radius * (1 + tolerated) + share_ * ball.gap_wall;
  }
  double least_distance(std::size_t one, std::size_t other) const {
    return (balls_[one].radius + balls_[other].radius) * (1 + tolerated) +
        share_ * balls_[std::max(one, other)].gap_ball;
  }

  /// @return whether they were apart
  bool part(std::size_t one, std::size_t other) {
    CrowdBall &a = balls_[one], &b = balls_[other];
    Place between = a.place - b.place;
    const double least = least_distance(one, other), square = squared_norm<double>(between);
    if (square >= least * least) return true;
    double distance = std::sqrt(square);
    if (!(distance > 0)) between = Place(0, distance = 1, 0);
    const double push = least * (1 + farther) - std::sqrt(square);
    const double of_one = a.fixed ? 0 : b.fixed ? 1 : 0.5;
    a.place += between * (push * of_one / distance);
    b.place -= between * (push * (a.fixed ? 1 : 1 - of_one) / distance);
    return a.fixed && b.fixed;
  }

  /// @return whether the ball was inside
  bool bring_inside(std::size_t k) {
    const auto& [distance, room] = *rooms_.find(distance_from_walls(balls_[k]));
    Place& p = balls_[k].place;
    bool clear = true;
    for (const auto& [frame, shape] : bodies_) {
      const auto around = shape.inset(distance);
      const double overlap = around.overlap(0, frame.inside(p));
      if (!(overlap > 0)) continue;
      clear = false;
      const Place away = frame.outside(around.normal(0, frame.inside(p))) - frame.origin;
      p += away * (overlap + farther * balls_[k].radius / 16);
    }
    if (room.contains(p) && is_clear_of_pistons(p, distance)) return clear;
    for (int wall = 0; wall < vessel_.wall_count(); ++wall) {
      const double moved = moved_.empty() ? 0 : moved_[static_cast<std::size_t>(wall)];
      const double overlap = room.overlap(wall, p) + moved;
      if (overlap > 0) p += room.normal(wall, p) * (overlap + farther * balls_[k].radius / 16);
    }
    return false;
  }
  bool is_clear_of_pistons(const Place& p, double distance) const {
    for (int wall = 0; const double moved : moved_)
      if (const int own = wall++; moved != 0 && vessel_.gap(own, p) < distance + moved)
        return false;
    return true;
  }

  bool have_gone_far() const {
    if (begin_.empty()) return true;
    const double most = skin() * skin() / 4;
    for (std::size_t k = 0; k < balls_.size(); ++k)
      if (squared_norm<double>(balls_[k].place - begin_[k]) > most) return true;
    return false;
  }

  /// Finds the pairs that can come too close before a ball has moved by half the skin.
  void find_pairs() {
    begin_.clear();
    for (const auto& ball : balls_) begin_.push_back(ball.place);
    pairs_.clear();
    Place low = begin_.front(), high = low;
    for (const auto& p : begin_) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    const Place extent = high - low;
    const auto cell_of = [&](const Place& p, int axis) {
      const int cells = static_cast<int>(std::clamp(extent[axis] / (widest_ + skin()), 1.0, 64.0));
      const double place = extent[axis] > 0 ? (p[axis] - low[axis]) / extent[axis] * cells : 0;
      return std::min(static_cast<int>(place), cells - 1);
    };
    boost::unordered_flat_map<std::array<int, 3>, std::vector<std::size_t>> cells;
    for (std::size_t k = 0; k < begin_.size(); ++k) {
      const auto& p = begin_[k];
      const int x = cell_of(p, 0), y = cell_of(p, 1), z = cell_of(p, 2);
      for (const int u : {x - 1, x, x + 1})
        for (const int v : {y - 1, y, y + 1})
          for (const int w : {z - 1, z, z + 1})
            for (const auto other : cells[{u, v, w}]) {
              const double reach = least_distance(other, k) + skin();
              if (squared_norm<double>(begin_[other] - p) < reach * reach)
                pairs_.emplace_back(other, k);
            }
      cells[{x, y, z}].push_back(k);
    }
  }

  /// Balls are pushed a little farther than they have to be, so that the pushes come to an end.
  static constexpr double farther = 1e-3, tolerated = 1e-7;

  const model::AnyVessel<double>& vessel_;
  const std::vector<double>& moved_;
  const std::vector<CrowdBody>& bodies_;
  std::vector<CrowdBall>& balls_;
  double share_;
  std::map<double, model::AnyVessel<double>> rooms_;  ///< by the distance of centres from the walls
  double widest_ = 0, slimmest_ = 1e300;
  std::vector<std::pair<std::size_t, std::size_t>> pairs_;
  std::vector<Place> begin_;  ///< places when the pairs were found
};

template <class Real> class Filling {
 public:
  Filling(const CaseSpec& spec, InitialCase<Real>& result)
      : spec_(spec), result_(result), mill_(result.the_case.mill),
        pose_(mill_.motion.pose(result.start)), random_(spec.seed), placed_(widest_distance(spec)) {
    for (const auto& body : mill_.bodies) body_poses_.push_back(body.motion.pose(result.start));
  }

  void fill() {
    for (const auto& ball : spec_.balls)
      add_checked(ball,
          {to_vector<Real>(ball.position), to_vector<Real>(ball.velocity),
              to_vector<Real>(ball.spin)});
    add_batches();
    require_good();
  }

  /// A ball whose state is given: it must be inside and touch no other, up to rounding.
  void add_checked(const BallSpec& spec, const model::BallState<Real>& state) {
    const auto ball = to_ball<Real>(spec, spec.diameter.to<Real>());
    const auto local = mill_.motion.to_vessel_frame(pose_, state.position, state.velocity).position;
    const auto report = [&](const std::string& what) {
      problems_.push_back(
          fmt::format("{}: found ball {} {}", spec.where, result_.states.size(), what));
    };
    const Real tolerance = ball.radius / 1000000000, radius = ball.radius - tolerance;
    if (mill_.vessel.inset(ball.radius).is_empty())
      report("as large as the vessel, expected one that has room to move");
    else if (!mill_.vessel.inset(radius).contains(local) || !clears_pistons(local, radius))
      report("outside the vessel, expected it inside");
    else if (const auto* body = body_at(local, radius))
      report("overlapping " + body->name.label + ", expected it outside of bodies");
    const int other = placed_.conflict(
        local, [&](int k) { return ball.radius + result_.the_case.balls[k].radius - tolerance; });
    if (other >= 0)
      report(fmt::format("overlapping ball {}, expected balls that do not overlap", other));
    add(ball, local, state);
  }

  /// @throws InputError when a ball did not fit
  void require_good() const {
    if (!problems_.empty()) throw InputError(problems_);
  }
 private:
  /// Places the balls of the batches one by one at random; all together if one finds no room.
  void add_batches() {
    if (!fit_alone() || !fit_by_volume() || !problems_.empty()) return;
    const std::size_t given = result_.states.size();
    for (const auto& batch : spec_.batches)
      for (int k = 0; k < batch.count; ++k) {
        const auto ball = draw_ball(batch);
        if (const auto local = place(batch, ball.radius)) {
          add(ball, *local, draw_state(batch, *local));
          continue;
        }
        result_.the_case.balls.resize(given);
        result_.states.resize(given);
        return add_together();
      }
  }

  static double widest_distance(const CaseSpec& spec) {
    double gap = 0;
    for (const auto& b : spec.batches) gap = std::max(gap, b.gap_ball.to<double>());
    return (spec.largest_diameter() + gap) * 1.001;
  }

  /// The body that a ball at this place overlaps; null for none.
  const model::Body<Real>* body_at(const Vec3<Real>& local, const Real& radius) const {
    if (mill_.bodies.empty()) return nullptr;
    const auto place = mill_.motion.to_inertial(pose_, local);
    for (std::size_t k = 0; k < mill_.bodies.size(); ++k) {
      const auto& body = mill_.bodies[k];
      if (!body.shape.inset(radius).contains(body.motion.position_in_vessel(body_poses_[k], place)))
        return &body;
    }
    return nullptr;
  }
  bool clears_pistons(const Vec3<Real>& local, const Real& radius) const {
    const auto* pistons = mill_.vessel.pistons();
    for (std::size_t k = 0; pistons && k < pistons->count(); ++k)
      if (mill_.vessel.gap(pistons->wall(k), local) < radius + pistons->at(k, result_.start).value)
        return false;
    return true;
  }

  model::BallProperties<Real> draw_ball(const BallBatch& batch) {
    const Real diameter = batch.diameter.to<Real>(), spread = batch.diameter_spread.to<Real>();
    return to_ball<Real>(
        batch, spread > 0 ? Real(diameter + spread * random_.symmetric<Real>()) : diameter);
  }
  model::BallState<Real> draw_state(const BallBatch& batch, const Vec3<Real>& local) {
    model::BallState<Real> state{mill_.motion.to_inertial(pose_, local),
        to_vector<Real>(batch.velocity), Vec3<Real>(Real(0), Real(0), Real(0))};
    if (batch.random_speed) state.velocity = random_velocity(batch.random_speed->to<Real>());
    return state;
  }

  void add(const model::BallProperties<Real>& ball, const Vec3<Real>& local,
      const model::BallState<Real>& state) {
    placed_.add(static_cast<int>(result_.states.size()), local);
    result_.the_case.balls.push_back(ball);
    result_.states.push_back(state);
  }

  /// A free place in the vessel, uniform over those that keep the gaps; nothing if none is found.
  std::optional<Vec3<Real>> place(const BallBatch& batch, const Real& radius) {
    const Real gap_ball = batch.gap_ball.to<Real>(), gap_wall = batch.gap_wall.to<Real>();
    const auto room = mill_.vessel.inset(radius).inset(gap_wall);
    if (room.is_empty()) return std::nullopt;
    const auto least = [&](int other) {
      return radius + result_.the_case.balls[other].radius + gap_ball;
    };
    for (std::uint64_t tries = 0; tries <= batch.max_relocations; ++tries) {
      const Real x = random_.symmetric<Real>(), z = random_.symmetric<Real>();
      const auto local = room.place({x, random_.symmetric<Real>(), z});
      if (local && clears_pistons(*local, radius + gap_wall) &&
          !body_at(*local, radius + gap_wall) && placed_.conflict(*local, least) < 0)
        return local;
    }
    return std::nullopt;
  }

  bool fit_alone() {
    const std::size_t before = problems_.size();
    for (const auto& batch : spec_.batches)
      if (mill_.vessel.inset((batch.diameter.to<Real>() + batch.diameter_spread.to<Real>()) / 2)
              .is_empty())
        problems_.push_back(batch.where +
            ": found balls too large for the vessel, expected a diameter that leaves them room");
    return problems_.size() == before;
  }

  double volume_of_balls() const {
    double sum = 0;
    spec_.for_each_ball([&](const BallSpec& ball) {
      const double d = ball.diameter.to<double>();
      sum += ball.count * numerics::pi<double>() / 6 * d * d * d;
    });
    return sum;
  }

  /// Volume without the bodies at the start [m3].
  double room() const {
    if (mill_.bodies.empty()) return static_cast<double>(mill_.vessel.volume());
    return free_volume(model::mill_cast<double>(mill_),
        {result_.start.period, static_cast<double>(result_.start.offset)});
  }

  /// Reports a volume that no packing reaches: for a dozen balls or more, pi/sqrt(18) of the room.
  bool fit_by_volume() {
    if (spec_.batches.empty()) return true;
    constexpr double densest = 0.7405, few = 12;
    const double vessel = room(), balls = volume_of_balls();
    const double most = static_cast<double>(spec_.ball_count()) < few ? 1 : densest;
    if (balls <= most * vessel || !(vessel > 0))
      return true;  // without any room no ball can be placed
    const auto& batch = spec_.batches.back();
    const double d = batch.diameter.to<double>(), one = numerics::pi<double>() / 6 * d * d * d;
    const double fitting = std::floor(batch.count - (balls - most * vessel) / one);
    problems_.push_back(
        fmt::format("{}: found balls that fill {:.3g} of the vessel's {}volume, expected at most "
                    "{:.3g} of it{}",
            batch.where, balls / vessel, mill_.bodies.empty() ? "" : "free ", most,
            fitting > 0 ? fmt::format(", with at most {:.0f} balls in this batch in place of {}",
                              fitting, batch.count)
                        : ""));
    return false;
  }

  /// A ball of a batch that is pushed apart from the others, from a random place.
  struct Drawn {
    const BallBatch* batch;
    model::BallProperties<Real> ball;
  };

  void add_together() {
    random_ = Random(spec_.seed);
    std::vector<Drawn> drawn;
    for (const auto& batch : spec_.batches)
      for (int k = 0; k < batch.count; ++k) drawn.push_back({&batch, draw_ball(batch)});
    std::vector<CrowdBall> crowd;
    // Tries smaller and smaller gaps.
    for (const double share : {1.0, 0.5, 0.25, 0.0625, 0.0})
      for (int attempt = 0; attempt < (share > 0 ? 2 : 8); ++attempt)
        if (part_crowd(drawn, drawn.size(), share, crowd)) return add_crowd(drawn, crowd);
    // Bisection for the number of balls that find room.
    std::size_t fitting = 0, failing = drawn.size();
    while (failing - fitting > 1) {
      const std::size_t middle = (fitting + failing) / 2;
      (part_crowd(drawn, middle, 0, crowd) ? fitting : failing) = middle;
    }
    if (fitting == 0 && !mill_.bodies.empty())
      return problems_.push_back(spec_.batches.front().where +
          ": no room for a ball between the bodies in the vessel: use smaller balls, or fewer "
          "bodies");
    problems_.push_back(fmt::format(
        "{}: found {} balls at a packing fraction of {:.3g}, expected fewer: only the first {} fit",
        spec_.batches.front().where, drawn.size(), volume_of_balls() / room(), fitting));
  }

  /// Pushes the first `count` drawn balls apart from new random places. @return true on success
  bool part_crowd(const std::vector<Drawn>& drawn, std::size_t count, double share,
      std::vector<CrowdBall>& crowd) {
    const auto vessel = mill_.vessel.template cast<double>();
    crowd.clear();
    for (std::size_t k = 0; k < result_.states.size(); ++k) {
      const auto& s = result_.states[k];
      const auto local = mill_.motion.to_vessel_frame(pose_, s.position, s.velocity).position;
      crowd.push_back({static_cast<double>(result_.the_case.balls[k].radius), 0, 0,
          vector_cast<double>(local), true});
    }
    for (std::size_t k = 0; k < count; ++k) {
      const auto& batch = *drawn[k].batch;
      const double radius = static_cast<double>(drawn[k].ball.radius);
      crowd.push_back({radius, batch.gap_ball.template to<double>(),
          batch.gap_wall.template to<double>(), random_place(vessel.inset(radius)), false});
    }
    std::vector<double> moved;
    const auto* pistons = mill_.vessel.pistons();
    for (int wall = 0; pistons && wall < mill_.vessel.wall_count(); ++wall)
      moved.push_back(static_cast<double>(pistons->of_wall(wall, result_.start).value));
    std::vector<CrowdBody> bodies;
    for (std::size_t k = 0; k < mill_.bodies.size(); ++k) {
      const auto& pose = body_poses_[k];
      const auto axis = [&](const Vec3<Real>& v) {
        return vector_cast<double>(mill_.motion.in_axes(pose_, v));
      };
      bodies.push_back({{vector_cast<double>(mill_.motion.position_in_vessel(pose_, pose.centre)),
                            axis(pose.x), axis(pose.y), axis(pose.z)},
          mill_.bodies[k].shape.template cast<double>()});
    }
    return Crowd(vessel, moved, bodies, crowd, share).push_apart();
  }
  Vec3<double> random_place(const model::AnyVessel<double>& room) {
    for (int tries = 0; tries < 10000; ++tries) {
      const double x = random_.symmetric<double>(), z = random_.symmetric<double>();
      if (const auto place = room.place({x, random_.symmetric<double>(), z})) return *place;
    }
    return {0, 0, 0};
  }
  void add_crowd(const std::vector<Drawn>& drawn, const std::vector<CrowdBall>& crowd) {
    const std::size_t given = result_.states.size();
    for (std::size_t k = 0; k < drawn.size(); ++k) {
      const auto local = vector_cast<Real>(crowd[given + k].place);
      add(drawn[k].ball, local, draw_state(*drawn[k].batch, local));
    }
  }

  /// Uniform direction, and a size uniform up to `largest`.
  Vec3<Real> random_velocity(const Real& largest) {
    for (;;) {
      const Vec3<Real> v{
          random_.symmetric<Real>(), random_.symmetric<Real>(), random_.symmetric<Real>()};
      const Real size = norm<Real>(v);
      if (size > 0 && !(size > 1)) return v * (largest * random_.uniform<Real>() / size);
    }
  }

  const CaseSpec& spec_;
  InitialCase<Real>& result_;
  const model::Mill<Real>& mill_;
  model::AnyPose<Real> pose_;
  std::vector<model::ChainPose<Real>> body_poses_;
  Random random_;
  PlacedBalls<Real> placed_;
  std::vector<std::string> problems_;
};

template <class Real>
inline constexpr auto to_scalar = [](const Quantity& q) { return q.to<Real>(); };

template <class Real, template <class> class Part> Part<Real> to_part(const Part<Quantity>& part) {
  return model::converted<Part, Real>(part, to_scalar<Real>);
}

template <class Real>
model::ChainMotion<Real> to_chain(const model::Joints<Quantity>& given, const CaseSpec& spec) {
  const auto& to = to_scalar<Real>;
  auto joints = model::converted_joints<Real>(with_phases(given), to);
  // Events are predicted some time beyond the end.
  if (spec.end_time) joints.times = {to(spec.initial_time), to(*spec.end_time) + joints.period};
  return model::ChainMotion<Real>(joints);
}

template <class Real> model::AnyMotion<Real> to_motion(const auto& part, const CaseSpec& spec) {
  if constexpr (requires { part.joints(); })
    return to_chain<Real>(part.joints(), spec);
  else
    return to_part<Real>(part).motion();
}

/// @param mill  without its bodies
template <class Real>
model::Body<Real> to_body(const Solid& body, const model::Mill<Real>& mill, const CaseSpec& spec) {
  const auto motion = to_chain<Real>({joints_from_ground(body, spec), period_of(spec.mill)}, spec);
  const Real domain =
      motion.reach(mill.motion.reach(mill.vessel.reach())) * (1 + rounding_margin<Real>());
  const model::RoundedBody<Real> shape(
      body.is_round, to_vector<Real>(body.core()), body.rounding.to<Real>());
  return {motion, shape.among(Real(spec.largest_diameter() / 2 * (1 + 1e-9)), domain),
      {body.name, body.name}, body.on_vessel};
}

template <class Real> model::Pistons<Real> to_pistons(const CaseSpec& spec) {
  const auto& to = to_scalar<Real>;
  const auto& period = period_of(spec.mill);
  std::vector<model::Piston<Real>> pistons;
  for (const auto& p : spec.pistons)
    pistons.push_back({p.wall, to(p.distance), to(p.speed),
        model::converted_swings<Real>(with_phases(p.swings, period), to)});
  return {std::move(pistons), to(period)};
}

/// The laws of pairs, with a table of which applies where.
template <class Real> model::PairLaws<Real> to_pairs(const CaseSpec& spec, int walls) {
  model::PairLaws<Real> pairs;
  if (spec.pairs.empty()) return pairs;
  pairs.materials = spec.materials.size() + 1;
  const auto law_of = [&](int one, int other) {
    for (std::size_t k = 0; k < spec.pairs.size(); ++k)
      if (spec.pairs[k].is_of(one, other)) return static_cast<int>(k);
    return -1;
  };
  for (int one = 0; one < static_cast<int>(pairs.materials); ++one) {
    for (int other = 0; other < static_cast<int>(pairs.materials); ++other)
      pairs.of_balls.push_back(law_of(one, other));
    for (std::size_t wall = 0; wall < static_cast<std::size_t>(walls); ++wall)
      pairs.of_walls.push_back(law_of(one, spec.wall_materials.at(wall)));
  }
  for (const auto& pair : spec.pairs)
    pairs.laws.push_back(model::convert_law<Real>(pair.law, to_scalar<Real>));
  return pairs;
}

/// Fills the case with its balls in the states of a final_state.csv.
template <class Real> void fill_from_file(const CaseSpec& spec, InitialCase<Real>& result) {
  const auto& file = spec.initial_state;
  const auto saved = io::read_final_state<Real>(file);
  if (saved.states.size() != spec.ball_count())
    throw InputError(fmt::format("{}: found {} balls, expected the case's {}", file,
        saved.states.size(), spec.ball_count()));
  const DriveClock<Real> clock(result.the_case.mill.motion.period());
  if (saved.time.offset >= clock.period())
    throw InputError(
        fmt::format("{}:2: found a drive_offset of a whole drive period or more, expected one "
                    "below the case's period of {} s",
            file, to_text<Real>(clock.period())));
  if (spec.end_time && saved.time >= *result.the_case.stop.end_time)
    throw InputError(
        fmt::format("{}:2: found a state at {} s, expected one before the case's end_time", file,
            to_text<Real>(clock.seconds(saved.time))));
  result.start = saved.time;
  Filling<Real> filling(spec, result);
  std::size_t k = 0;
  spec.for_each_ball([&](const BallSpec& b) {
    if (b.diameter_spread.positive())
      throw InputError(b.where +
          ": found diameter_spread with an initial state, expected balls of one diameter");
    for (int n = 0; n < b.count; ++n) filling.add_checked(b, saved.states[k++]);
  });
  filling.require_good();
}

/// Rejects balls as small as the rounding of a position, and hops that are lower than that.
template <class Real>
void require_resolution(const CaseSpec& spec, const InitialCase<Real>& built) {
  using std::sqrt;
  const auto& mill = built.the_case.mill;
  const Real reach = mill.motion.reach(mill.vessel.reach()), gravity = norm<Real>(mill.gravity);
  Real fastest = 2 * mill.motion.speed_within(reach) + 4 * sqrt(gravity * reach);
  Real acceleration = mill.motion.acceleration_within(reach);
  for (const auto& body : mill.bodies) {
    const Real size = body.motion.reach(body.shape.size());
    fastest = std::max<Real>(
        fastest, 2 * body.motion.wall_speed(body.shape.size()) + 4 * sqrt(gravity * reach));
    acceleration = std::max<Real>(acceleration, body.motion.acceleration_within(size));
  }
  for (const auto& state : built.states) fastest = std::max(fastest, norm<Real>(state.velocity));
  const Real rounding = epsilon<Real>() / 2 * (24 * reach + 16 * fastest * mill.motion.period());
  const Real least_radius = 8000000 * rounding;  // so that a missed impact differs from rounding
  const auto number = [](const Real& x) { return fmt::format("{:.3g}", static_cast<double>(x)); };
  std::vector<std::string> problems;
  spec.for_each_ball([&](const BallSpec& ball) {
    const Real radius =
        (ball.diameter.template to<Real>() - ball.diameter_spread.template to<Real>()) / 2;
    if (radius < least_radius)
      problems.push_back(fmt::format(
          "{}: found a ball of radius {} m, expected at least {} m: in this mill {} resolves a "
          "position to {} m: use a wider precision",
          ball.where, number(radius), number(least_radius), scalar_name<Real>(), number(rounding)));
  });
  const Real least_hop = 4 * sqrt(rounding * (acceleration + gravity));
  const auto check_least = [&](const Real& speed, const std::string& section) {
    if (speed > 0 && speed < least_hop)
      problems.push_back(
          fmt::format("{}: key '{}.least_separation': found {} m/s, expected 0 or at least {} m/s: "
                      "hops of a slower ball are lost in the rounding of {}",
              spec.file, section, number(speed), number(least_hop), scalar_name<Real>()));
  };
  check_least(mill.ball_ball.least_separation, "contact.ball_ball");
  check_least(mill.ball_wall.least_separation, "contact.ball_wall");
  for (std::size_t k = 0; k < mill.pairs.laws.size(); ++k)
    check_least(mill.pairs.laws[k].least_separation, "contact.pair." + std::to_string(k));
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace detail

template <class Real> model::Mill<Real> build_mill(const CaseSpec& spec) {
  auto vessel = std::visit(
      [](const auto& v) { return model::AnyVessel<Real>(detail::to_part<Real>(v).vessel()); },
      spec.vessel);
  if (!spec.pistons.empty()) vessel.set(detail::to_pistons<Real>(spec));
  const int walls = vessel.wall_count() + static_cast<int>(spec.bodies.size());
  model::Mill<Real> mill{
      std::visit([&](const auto& m) { return detail::to_motion<Real>(m, spec); }, spec.mill),
      std::move(vessel), detail::to_vector<Real>(spec.gravity),
      model::convert_law<Real>(spec.ball_ball, detail::to_scalar<Real>),
      model::convert_law<Real>(spec.ball_wall, detail::to_scalar<Real>),
      detail::to_pairs<Real>(spec, walls)};
  for (const auto& body : spec.bodies)
    mill.bodies.push_back(detail::to_body<Real>(body, mill, spec));
  return mill;
}

template <class Real>
InitialCase<Real> build_case_in(
    const model::Mill<Real>& mill, const CaseSpec& spec, bool resolved) {
  InitialCase<Real> result;
  auto& c = result.the_case;
  c.mill = mill;
  const auto& period = period_of(spec.mill);
  c.initial_time = instant_at<Real>(spec.initial_time, period);
  c.statistics_start = instant_at<Real>(spec.statistics_start, period);
  if (const auto& counted = spec.target.counted; spec.target.dose)
    c.counted_dose = {counted.normal_only, counted.least.template to<Real>()};
  if (spec.end_time) c.stop.end_time = instant_at<Real>(*spec.end_time, period);
  for (std::size_t place = 0; place < model::stop_rule_count; ++place)
    if (const auto& limit = spec.stop_limits[place])
      c.stop.limits[place] = limit->template to<Real>();
  result.start = c.initial_time;
  if (spec.initial_state.empty())
    detail::Filling<Real>(spec, result).fill();
  else
    detail::fill_from_file(spec, result);
  if (resolved) detail::require_resolution(spec, result);
  return result;
}

}  // namespace edmill::casefile
