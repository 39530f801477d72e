// States of a ball near a wall that are hard for a search: drawn in float128, used in any scalar.
#pragma once

#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "core.hpp"
#include "dynamics/wall_search.hpp"
#include "mill_parts.hpp"

namespace edmill::dynamics {

template <class To> model::Mill<To> widened(const model::Mill<double>& m) {
  auto wide = model::mill_cast<To>(m);
  wide.ball_ball = wide.ball_wall = {};
  return wide;
}

template <class To> WallQuery<To> widened(const WallQuery<double>& q) {
  return {flight_cast<To>(q.flight), To(q.radius), instant_cast<To>(q.begin), To(q.length)};
}

/// Reproducible draws; the distributions of <random> differ between libraries.
class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}
  double uniform() { return static_cast<double>(bits_() >> 11) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }
  double symmetric() { return 2 * uniform() - 1; }
  double log_uniform(double low, double high) { return low * std::pow(high / low, uniform()); }
  double sign() { return chance(0.5) ? 1 : -1; }
  bool chance(double p) { return uniform() < p; }
  int below(int n) { return static_cast<int>(uniform() * n); }
 private:
  std::mt19937_64 bits_;
};

enum class Kind {
  leaving,
  touching,
  near,
  grazing,
  dipping,
  seam,
  corner_hit,
  in_corner,
  axis,
  anywhere
};
constexpr Kind all_kinds[] = {Kind::leaving, Kind::touching, Kind::near, Kind::grazing,
    Kind::dipping, Kind::seam, Kind::corner_hit, Kind::in_corner, Kind::axis, Kind::anywhere};

inline std::string name(Kind kind) {
  switch (kind) {
    case Kind::leaving: return "on a wall, leaving";
    case Kind::touching: return "on a wall, approaching or overlapped";
    case Kind::near: return "near a wall";
    case Kind::grazing: return "grazing";
    case Kind::dipping: return "through a wall and back in a long window";
    case Kind::seam: return "near the seam";
    case Kind::corner_hit: return "cap and cylinder at one time";
    case Kind::in_corner: return "on two walls at the begin";
    case Kind::axis: return "near the axis";
    case Kind::anywhere: return "anywhere";
  }
  return "";
}

/// Position and velocity of a ball in the vessel frame at an instant.
struct Placement {
  Vec3<float128> position, velocity;
};

/// Draws states of one mill. Wide arithmetic places the ball; the query holds the rounded state.
class StateMaker {
 public:
  StateMaker(const model::Mill<double>& mill, double longest)
      : mill_(widened<float128>(mill)), constants_(testing::moving(mill_)), longest_(longest) {}

  /// Distance from tangency of grazing paths [m]; zero draws a new one for each.
  double grazing_distance = 0;

  /// @param turning  the window begins near a turning point of the drive
  WallQuery<double> operator()(Draw& draw, Kind kind, bool turning) const {
    for (;;) {
      const auto query = attempt(draw, kind, turning);
      const testing::GeneralFunctions<float128> gaps(constants_,
          flight_cast<float128>(query.flight), float128(query.radius), query.begin.period);
      const auto sample = gaps(float128(query.begin.offset));
      // A state of the solver is inside the vessel up to rounding.
      bool inside = true;
      const float128 begin(query.begin.offset);
      const auto active = gaps.room().active(gaps.seen(begin, gaps.pose(begin)).state.position);
      for (int wall = 0; wall < mill_.vessel.wall_count(); ++wall) {
        inside &= !active[wall] ||
            sample.gap[wall] > -3e-15 * testing::gap_per_metre(mill_, wall, float128(query.radius));
        // Rates that are exactly zero are for tests with another oracle: engine/corners_test.cpp.
        const bool level = abs(sample.rate[wall]) < 1e-30 && abs(sample.gap[wall]) < 1e-12;
        inside &= kind != Kind::in_corner || !level;
      }
      if (inside) return query;
    }
  }
 private:
  WallQuery<double> attempt(Draw& draw, Kind kind, bool turning) const {
    const double period = static_cast<double>(mill_.motion.period());
    WallQuery<double> q{};
    q.radius = draw.uniform(0.00118, 0.00635);
    q.length =
        draw.chance(0.5) ? draw.uniform(0.0, longest_) : draw.log_uniform(1e-6, 1) * longest_;
    if (kind == Kind::dipping || draw.chance(0.1)) q.length = longest_;
    if (!(q.length > 0)) q.length = longest_;
    double offset = draw.uniform(0, period);
    if (turning) {
      offset = 0.25 * draw.below(5) * period;
      if (draw.chance(0.8)) offset += draw.sign() * draw.log_uniform(1e-15, 1e-2) * period;
    }
    if (!(offset >= 0 && offset < period)) offset = 0;
    const std::int64_t periods[] = {0, 2, 17, 123456, 1000000007};
    q.begin = {periods[draw.below(testing::slides(mill_) ? 3 : 5)], offset};

    // The instant at which the ball is placed: begin, or within the window.
    float128 later = 0;
    if (kind == Kind::grazing || kind == Kind::dipping || kind == Kind::corner_hit)
      later = q.length * draw.uniform();
    Placement placed = place(draw, kind, q.radius);
    follow_pistons(placed, {q.begin.period, float128(q.begin.offset) + later}, q.radius);

    // The flight starts at begin, earlier in that period, or in an earlier period.
    q.flight.start = q.begin;
    const double how = draw.uniform();
    if (how > 0.7) {
      q.flight.start.period -= draw.chance(0.1) ? 2 : 1;
      q.flight.start.offset =
          draw.chance(0.3) ? std::nextafter(period, 0.0) : draw.uniform(0, period);
    } else if (how > 0.4) {
      q.flight.start.offset = draw.chance(0.5) ? draw.uniform(0, q.begin.offset)
                                               : q.begin.offset * (1 - draw.log_uniform(1e-12, 1));
      if (!(q.flight.start.offset >= 0)) q.flight.start.offset = 0;
    }
    set_flight(q, placed, later);
    return q;
  }

  /// What is placed near a wall that moves in the vessel goes along with it.
  void follow_pistons(Placement& placed, const Instant<float128>& when, double radius) const {
    const auto* pistons = mill_.vessel.pistons();
    for (std::size_t k = 0; pistons && k < pistons->count(); ++k) {
      const int wall = pistons->wall(k);
      if (mill_.vessel.gap(wall, placed.position) > 2 * radius) continue;
      const auto moved = pistons->at(k, when);
      const Vec3<float128> normal = mill_.vessel.normal(wall, placed.position);
      placed.position += normal * moved.value;
      placed.velocity += normal * moved.rate;
    }
  }

  /// Moves the placed ball from `later` after begin back to the start of the flight, and rounds.
  void set_flight(WallQuery<double>& q, const Placement& placed, const float128& later) const {
    const float128 when = q.begin.offset + later;
    const auto pose = mill_.motion.pose({q.begin.period, when});
    const Vec3<float128> at = mill_.motion.to_inertial(pose, placed.position);
    Vec3<float128> velocity = mill_.motion.wall_velocity(pose, at);
    const auto &x = mill_.motion.axis_x(pose), &y = mill_.motion.axis_y(pose),
               &z = mill_.motion.axis_z(pose);
    for (int k = 0; k < 3; ++k)
      velocity[k] +=
          x[k] * placed.velocity[0] + y[k] * placed.velocity[1] + z[k] * placed.velocity[2];
    const float128 flown =
        float128(q.begin.period - q.flight.start.period) * mill_.motion.period() +
        (when - float128(q.flight.start.offset));
    for (int k = 0; k < 3; ++k) {
      const float128& g = mill_.gravity[k];
      q.flight.position[k] =
          static_cast<double>(at[k] - velocity[k] * flown + g * flown * flown / 2);
      q.flight.velocity[k] = static_cast<double>(velocity[k] - g * flown);
    }
  }

  /// Gives `set(wall, gap, approach speed)` what the kind asks for; `corner()` names two walls that
  /// meet.
  template <class Set, class Corner>
  void put(Draw& draw, Kind kind, double top, int wall, Set&& set, Corner&& corner) const {
    switch (kind) {
      case Kind::leaving: set(wall, 0, -draw.log_uniform(1e-12, 10)); break;
      case Kind::touching:
        if (draw.chance(0.5))
          set(wall, 0, draw.log_uniform(1e-12, 10));
        else
          set(wall, -draw.log_uniform(1e-18, 2e-15), draw.sign() * draw.log_uniform(1e-12, 10));
        break;
      case Kind::near: set(wall, draw.log_uniform(1e-12, 1e-3), top * draw.symmetric()); break;
      case Kind::grazing: {
        // A third of them within or near the rounding of the state itself.
        const double drawn =
            draw.chance(1.0 / 3) ? draw.log_uniform(1e-18, 1e-14) : draw.log_uniform(1e-14, 1e-9);
        set(wall, draw.sign() * (grazing_distance > 0 ? grazing_distance : drawn), 0);
        break;
      }
      case Kind::dipping: set(wall, -draw.log_uniform(1e-9, 1e-4), 0); break;
      case Kind::seam: {
        const auto [first, second] = corner();
        set(first, draw.log_uniform(1e-12, 1e-4), top * draw.symmetric());
        set(second, draw.log_uniform(1e-12, 1e-4), top * draw.symmetric());
        break;
      }
      case Kind::corner_hit: {
        const auto [first, second] = corner();
        set(first, 0, draw.log_uniform(1e-6, 5));
        set(second, 0, draw.log_uniform(1e-6, 5));
        break;
      }
      case Kind::in_corner: {
        const auto [first, second] = corner();
        struct Touch {
          double gap, approach;
        };
        const auto touch = [&] {
          return Touch{draw.chance(0.5) ? 0 : -draw.log_uniform(1e-18, 2e-15),
              draw.sign() *
                  (draw.chance(0.2) ? draw.log_uniform(1e-25, 1e-12) : draw.log_uniform(1e-12, 5))};
        };
        const Touch one = touch(), other = touch();
        for (int step = 0; step < 30; ++step) {  // walls need not be perpendicular
          set(first, one.gap, one.approach);
          set(second, other.gap, other.approach);
        }
        break;
      }
      case Kind::axis:
      case Kind::anywhere: break;
    }
  }

  Placement place(Draw& draw, Kind kind, double radius) const {
    if (!mill_.vessel.get_if<model::CylinderVessel<float128>>())
      return place_in_any(draw, kind, radius);
    const float128 across = testing::cylinder(mill_).radius - float128(radius);  // of the axis
    const float128 along =
        testing::cylinder(mill_).half_height - float128(radius);  // of the middle plane
    const int wall = draw.below(3);
    float128 cap_gap = along * draw.uniform(), side_gap = across * (1 - std::sqrt(draw.uniform()));
    const double cap_side = wall == 2 ? draw.sign() : (wall == 0 ? -1 : 1);
    float128 out_along = 0, out_across = 0;  // velocity towards the cap and towards the cylinder
    bool free_along = true, free_across = true;
    const double top = draw.chance(0.5) ? draw.uniform(0.0, 5.7) : draw.log_uniform(1e-6, 5.7);
    // Gap and approach speed of the wall in question.
    const auto set = [&](int which, const float128& gap, const float128& approach) {
      (which == 2 ? side_gap : cap_gap) = gap;
      (which == 2 ? out_across : out_along) = approach;
      (which == 2 ? free_across : free_along) = false;
    };
    put(draw, kind, top, wall, set, [&] { return std::pair(2, 0); });
    if (kind == Kind::axis) side_gap = across - float128(draw.log_uniform(1e-12, 1e-3));
    if (free_along) out_along = top * draw.symmetric();
    if (free_across) out_across = top * draw.symmetric();
    const float128 angle = draw.uniform(0, 6.283185307179586);
    const float128 cosine = cos(angle), sine = sin(angle);
    const float128 distance = across - side_gap, around = top * draw.symmetric();
    return {{distance * cosine, cap_side * (along - cap_gap), distance * sine},
        {out_across * cosine - around * sine, cap_side * out_along,
            out_across * sine + around * cosine}};
  }

  /// Places a ball by what every vessel says of itself.
  Placement place_in_any(Draw& draw, Kind kind, double radius) const {
    const auto room = mill_.vessel.inset(float128(radius));
    std::optional<Vec3<float128>> p;
    while (!p) p = room.place({draw.symmetric(), draw.symmetric(), draw.symmetric()});
    const double top = draw.chance(0.5) ? draw.uniform(0.0, 5.7) : draw.log_uniform(1e-6, 5.7);
    Vec3<float128> u{top * draw.symmetric(), top * draw.symmetric(), top * draw.symmetric()};
    const auto set = [&](int wall, const float128& gap, const float128& approach) {
      for (int step = 0; step < 20; ++step)  // towards a wall that may be curved
        *p += room.normal(wall, *p) * float128(room.overlap(wall, *p) + gap);
      const auto n = room.normal(wall, *p);
      u -= n * float128(dot<float128>(u, n) + approach);
    };
    const int wall = draw.below(room.wall_count());
    const auto other = [&] {
      for (;;) {
        const int found = draw.below(room.wall_count());
        if (room.wall_count() == 1) return found;
        if (abs(dot<float128>(room.normal(found, *p), room.normal(wall, *p))) < 0.9) return found;
      }
    };
    if (const auto* rounded = room.get_if<model::RoundedVessel<float128>>()) {
      // Walls meet without an edge: near the border between two of them.
      put(draw, kind, top, wall, set, [&] {
        (*p)[1] = draw.sign() * (rounded->core_half() + draw.sign() * draw.log_uniform(1e-9, 1e-4));
        u[1] *= draw.chance(0.5) ? 1 : 1e-6;
        return std::pair(wall, wall);
      });
      return {*p, u};
    }
    put(draw, kind, top, wall, set, [&] { return std::pair(other(), wall); });
    return {*p, u};
  }

  model::Mill<float128> mill_;
  testing::GeneralMill<float128> constants_;
  double longest_;
};
/// A search may prove only a part of the window; this repeats it up to the end.
template <class Decide, class Real>
WallAnswer<Real> over_window(Decide&& decide, WallQuery<Real> query, const Real& period) {
  const DriveClock<Real> clock(period);
  for (int parts = 1;; ++parts) {
    if (parts == 10000) throw std::runtime_error("the search does not get ahead");
    const WallAnswer<Real> answer = decide(query);
    const Real left = query.length - answer.searched;
    if (answer.verdict != Verdict::none || !(left > epsilon<Real>() * period)) return answer;
    query.begin = clock.after(query.begin, answer.searched);
    query.length = left;
  }
}

}  // namespace edmill::dynamics
