// The balls of a case at its start: given states, random places, and crowds that are pushed apart.
#pragma once

#include <fmt/format.h>

#include <array>
#include <boost/unordered/unordered_flat_map.hpp>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/push_apart.hpp"
#include "casefile/random.hpp"

namespace edmill::casefile::detail {

template <class Real>
Vec3<Real> to_vector(const casefile::QuantityVector& q) {
  return {q[0].to<Real>(), q[1].to<Real>(), q[2].to<Real>()};
}

template <class Real>
model::BallProperties<Real> to_ball(const casefile::BallSpec& spec, const Real& diameter) {
  const Real radius = diameter / 2;
  const Real volume = 4 * numerics::pi<Real>() * (radius * radius * radius) / 3;
  return {radius, spec.density.to<Real>() * volume, spec.reduced_inertia.to<Real>(), spec.material};
}

/// Placed balls by cells of at least the widest centre distance that matters, in the vessel frame.
template <class Real>
class PlacedBalls {
 public:
  explicit PlacedBalls(double cell) : cell_(cell) {}

  void add(int index, const Vec3<Real>& p) { cells_[key(p, 0, 0, 0)].push_back({index, p}); }

  /// A ball closer to `p` than `least(index)`, or -1.
  template <class Least>
  int conflict(const Vec3<Real>& p, Least&& least) const {
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
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
  struct Entry {
    int index;
    Vec3<Real> position;
  };
  double cell_;
  boost::unordered_flat_map<Key, std::vector<Entry>> cells_;
};

template <class Real>
class Filling {
 public:
  Filling(const casefile::CaseSpec& spec, InitialCase<Real>& result)
      : spec_(spec),
        result_(result),
        mill_(result.the_case.mill),
        pose_(mill_.motion.pose(result.start)),
        random_(spec.seed),
        placed_(widest_distance(spec)) {}

  void add_explicit(const casefile::ExplicitBall& spec) {
    const auto ball = to_ball<Real>(spec, spec.diameter.to<Real>());
    const model::BallState<Real> state{to_vector<Real>(spec.position), to_vector<Real>(spec.velocity),
                                       to_vector<Real>(spec.spin)};
    add_checked(ball, state, spec.where);
  }

  /// A ball whose state is given: it must be inside and touch no other, up to rounding.
  void add_checked(const model::BallProperties<Real>& ball, const model::BallState<Real>& state,
                   const std::string& where) {
    const auto local = mill_.motion.to_vessel_frame(pose_, state.position, state.velocity).position;
    const std::string own = std::to_string(result_.states.size());
    const Real tolerance = ball.radius / 1000000000;
    if (mill_.vessel.inset(ball.radius).is_empty())
      problems_.push_back(where + ": found ball " + own +
                          " as large as the vessel, expected one that has room to move");
    else if (!inside(local, ball.radius - tolerance))
      problems_.push_back(where + ": found ball " + own + " outside the vessel, expected it inside");
    const int other = placed_.conflict(
        local, [&](int k) { return ball.radius + result_.the_case.balls[k].radius - tolerance; });
    if (other >= 0)
      problems_.push_back(where + ": found ball " + own + " overlapping ball " + std::to_string(other) +
                          ", expected balls that do not overlap");
    add(ball, local, state);
  }

  /// Each ball of the batches at random where it finds room, or else all together.
  void add_batches() {
    if (!fit_alone() || !fit_by_volume() || !problems_.empty()) return;
    const std::size_t given = result_.states.size();
    for (const auto& batch : spec_.batches) {
      if (add_batch(batch)) continue;
      result_.the_case.balls.resize(given);
      result_.states.resize(given);
      return add_together();
    }
  }

  const std::vector<std::string>& problems() const { return problems_; }

 private:
  static double widest_distance(const casefile::CaseSpec& spec) {
    double diameter = 0, gap = 0;
    for (const auto& b : spec.balls) diameter = std::max(diameter, b.diameter.to<double>());
    for (const auto& b : spec.batches) {
      diameter = std::max(diameter, b.diameter.to<double>() + b.diameter_spread.to<double>());
      gap = std::max(gap, b.gap_ball.to<double>());
    }
    return (diameter + gap) * 1.001;
  }

  bool inside(const Vec3<Real>& local, const Real& radius) const {
    return mill_.vessel.inset(radius).contains(local) && clears_pistons(local, radius);
  }
  bool clears_pistons(const Vec3<Real>& local, const Real& radius) const {
    const auto* pistons = mill_.vessel.pistons();
    for (std::size_t k = 0; pistons && k < pistons->count(); ++k)
      if (mill_.vessel.gap(pistons->wall(k), local) < radius + pistons->at(k, result_.start).value)
        return false;
    return true;
  }

  /// @return whether each has found room
  bool add_batch(const casefile::BallBatch& batch) {
    for (int k = 0; k < batch.count; ++k) {
      const auto ball = draw_ball(batch);
      const auto local = place(batch, ball.radius);
      if (!local) return false;
      add(ball, *local, draw_state(batch, *local));
    }
    return true;
  }

  model::BallProperties<Real> draw_ball(const casefile::BallBatch& batch) {
    const Real diameter = batch.diameter.to<Real>(), spread = batch.diameter_spread.to<Real>();
    return to_ball<Real>(batch, spread > 0 ? Real(diameter + spread * random_.symmetric<Real>()) : diameter);
  }
  model::BallState<Real> draw_state(const casefile::BallBatch& batch, const Vec3<Real>& local) {
    model::BallState<Real> state{mill_.motion.to_inertial(pose_, local), to_vector<Real>(batch.velocity),
                                 Vec3<Real>(Real(0), Real(0), Real(0))};
    if (batch.random_speed) state.velocity = random_velocity(batch.random_speed->to<Real>());
    return state;
  }

  void add(const model::BallProperties<Real>& ball, const Vec3<Real>& local,
           const model::BallState<Real>& state) {
    placed_.add(static_cast<int>(result_.states.size()), local);
    result_.the_case.balls.push_back(ball);
    result_.states.push_back(state);
  }

  /// A free place in the vessel frame, uniform over those that keep the gaps; nothing when it is not found.
  std::optional<Vec3<Real>> place(const casefile::BallBatch& batch, const Real& radius) {
    const Real gap_ball = batch.gap_ball.to<Real>(), gap_wall = batch.gap_wall.to<Real>();
    const auto room = mill_.vessel.inset(radius).inset(gap_wall);
    if (room.is_empty()) return std::nullopt;
    for (std::uint64_t tries = 0; tries <= batch.max_relocations; ++tries) {
      const Real x = random_.symmetric<Real>(), z = random_.symmetric<Real>(), y = random_.symmetric<Real>();
      const auto local = room.place({x, y, z});
      if (!local || !clears_pistons(*local, radius + gap_wall)) continue;
      if (placed_.conflict(*local, [&](int other) {
            return radius + result_.the_case.balls[other].radius + gap_ball;
          }) < 0)
        return local;
    }
    return std::nullopt;
  }

  bool fit_alone() {
    bool all = true;
    for (const auto& batch : spec_.batches) {
      const Real largest = (batch.diameter.to<Real>() + batch.diameter_spread.to<Real>()) / 2;
      if (!mill_.vessel.inset(largest).is_empty()) continue;
      all = false;
      problems_.push_back(
          batch.where + ": found balls too large for the vessel, expected a diameter that leaves them room");
    }
    return all;
  }

  double volume_of_balls() const {
    double sum = 0;
    const auto add = [&](const casefile::BallSpec& ball, int count) {
      const double d = ball.diameter.to<double>();
      sum += count * numerics::pi<double>() / 6 * d * d * d;
    };
    for (const auto& ball : spec_.balls) add(ball, 1);
    for (const auto& batch : spec_.batches) add(batch, batch.count);
    return sum;
  }

  /// Refuses what no packing holds: from a dozen balls on none is denser than that of equal ones,
  /// pi/sqrt(18).
  bool fit_by_volume() {
    if (spec_.batches.empty()) return true;
    constexpr double densest = 0.7405, few = 12;
    const double vessel = static_cast<double>(mill_.vessel.volume()), balls = volume_of_balls();
    const double most = static_cast<double>(spec_.ball_count()) < few ? 1 : densest;
    if (balls <= most * vessel) return true;
    const auto& batch = spec_.batches.back();
    const double d = batch.diameter.to<double>(), one = numerics::pi<double>() / 6 * d * d * d;
    const double fitting = std::floor(batch.count - (balls - most * vessel) / one);
    problems_.push_back(fmt::format(
        "{}: found balls that fill {:.3g} of the vessel's volume, expected at most {:.3g} of it{}",
        batch.where, balls / vessel, most,
        fitting > 0
            ? fmt::format(", with at most {:.0f} balls in this batch in place of {}", fitting, batch.count)
            : ""));
    return false;
  }

  /// What is pushed apart: balls whose state is given stay, those of batches begin at random places.
  struct Drawn {
    const casefile::BallBatch* batch;
    model::BallProperties<Real> ball;
  };

  void add_together() {
    random_ = Random(spec_.seed);
    std::vector<Drawn> drawn;
    for (const auto& batch : spec_.batches)
      for (int k = 0; k < batch.count; ++k) drawn.push_back({&batch, draw_ball(batch)});
    std::vector<CrowdBall> crowd;
    // Gaps shrink as they must.
    for (const double share : {1.0, 0.5, 0.25, 0.0625, 0.0})
      for (int attempt = 0; attempt < (share > 0 ? 2 : 8); ++attempt)
        if (part_crowd(drawn, drawn.size(), share, crowd)) return add_crowd(drawn, crowd);
    // How many do find room, from the first on.
    std::size_t fitting = 0, failing = drawn.size();
    while (failing - fitting > 1) {
      const std::size_t middle = (fitting + failing) / 2;
      (part_crowd(drawn, middle, 0, crowd) ? fitting : failing) = middle;
    }
    problems_.push_back(fmt::format(
        "{}: found {} balls at a packing fraction of {:.3g}, expected fewer: the first {} find room",
        spec_.batches.front().where, drawn.size(),
        volume_of_balls() / static_cast<double>(mill_.vessel.volume()), fitting));
  }

  /// The first `count` of the balls drawn, from new random places.
  bool part_crowd(const std::vector<Drawn>& drawn, std::size_t count, double share,
                  std::vector<CrowdBall>& crowd) {
    const auto vessel = mill_.vessel.template cast<double>();
    crowd.clear();
    for (std::size_t k = 0; k < result_.states.size(); ++k) {
      const auto& s = result_.states[k];
      const auto local = mill_.motion.to_vessel_frame(pose_, s.position, s.velocity).position;
      crowd.push_back(
          {static_cast<double>(result_.the_case.balls[k].radius), 0, 0, vector_cast<double>(local), true});
    }
    for (std::size_t k = 0; k < count; ++k) {
      const auto& batch = *drawn[k].batch;
      const double radius = static_cast<double>(drawn[k].ball.radius);
      crowd.push_back({radius, batch.gap_ball.template to<double>(), batch.gap_wall.template to<double>(),
                       random_place(vessel.inset(radius)), false});
    }
    return push_apart(vessel, moved_walls(), crowd, share);
  }
  Vec3<double> random_place(const model::AnyVessel<double>& room) {
    for (int tries = 0; tries < 10000; ++tries) {
      const double x = random_.symmetric<double>(), z = random_.symmetric<double>(),
                   y = random_.symmetric<double>();
      if (const auto place = room.place({x, y, z})) return *place;
    }
    return {0, 0, 0};
  }
  std::vector<double> moved_walls() const {
    std::vector<double> moved;
    const auto* pistons = mill_.vessel.pistons();
    for (int wall = 0; pistons && wall < mill_.vessel.wall_count(); ++wall)
      moved.push_back(static_cast<double>(pistons->of_wall(wall, result_.start).value));
    return moved;
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
      const Vec3<Real> v{random_.symmetric<Real>(), random_.symmetric<Real>(), random_.symmetric<Real>()};
      const Real size = norm<Real>(v);
      if (size > 1 || !(size > 0)) continue;
      return v * (largest * random_.uniform<Real>() / size);
    }
  }

  const casefile::CaseSpec& spec_;
  InitialCase<Real>& result_;
  const model::Mill<Real>& mill_;
  model::AnyPose<Real> pose_;
  Random random_;
  PlacedBalls<Real> placed_;
  std::vector<std::string> problems_;
};

}  // namespace edmill::casefile::detail
