// The room that bodies inside the vessel leave to the balls.
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/interruption.hpp"
#include "casefile/build_case.hpp"

namespace edmill::casefile {

namespace {

using Place = Vec3<double>;
using Body = model::Body<double>;

/// The k-th number of van der Corput's sequence, from 0 to 1.
double radical_inverse(int k, int base) {
  double sum = 0, share = 1;
  for (; k > 0; k /= base) {
    share /= base;
    sum += k % base * share;
  }
  return sum;
}

/// The nearest point of a body's core.
Place nearest(const Body& body, const model::ChainPose<double>& pose, const Place& place) {
  const auto local = body.motion.position_in_vessel(pose, place);
  const double away = body.shape.clearance(local) + body.shape.rounding();
  return away > 0
      ? Place(place - body.motion.direction_to_inertial(pose, body.shape.normal(0, local)) * away)
      : place;
}

/// Distance of two bodies, by projections in turn onto their cores; 0 or less if they overlap [m].
double distance(const Body& one, const Body& other, const Instant<double>& when) {
  const auto pose = one.motion.pose(when), pose_of_other = other.motion.pose(when);
  Place a = pose.centre, b = nearest(other, pose_of_other, a);
  for (int k = 0; k < 200; ++k) {
    const Place next = nearest(one, pose, b);
    const double moved = norm<double>(Place(next - a));
    a = next;
    b = nearest(other, pose_of_other, a);
    if (k > 0 && moved < 1e-9) break;
  }
  return norm<double>(Place(a - b)) - one.shape.rounding() - other.shape.rounding();
}

/// Points whose hull is the core of a body; of a round one, to 0.2 % of its radius outside.
std::vector<Place> corners_of(const model::RoundedBody<double>& shape) {
  std::vector<Place> corners;
  const auto& half = shape.half();
  constexpr int sides = 48;
  for (const int up : {-1, 1})
    for (int k = 0; k < (shape.is_round() ? sides : 4); ++k) {
      const auto turn = numerics::sin_cos_turns<double>((k + 0.5) / sides);
      const double wide = half[0] / std::cos(numerics::pi<double>() / sides);
      corners.push_back(shape.is_round()
              ? Place(wide * turn.cos, up * half[1], wide * turn.sin)
              : Place((k % 2 ? 1 : -1) * half[0], up * half[1], (k / 2 ? 1 : -1) * half[2]));
    }
  return corners;
}

/// Distance of a place from a wall [m]; from all of the surface of a vessel with rounded edges.
double depth(const model::AnyVessel<double>& vessel, int wall, const Place& place) {
  const double overlap = vessel.overlap(wall, place);
  const auto* rounded = vessel.get_if<model::RoundedVessel<double>>();
  if (!rounded || !vessel.contains(place)) return -overlap;
  double fits = 0, too_large = vessel.reach();  // a ball about the place
  for (int k = 0; k < 24; ++k) {
    const double radius = (fits + too_large) / 2;
    (rounded->inset(radius).contains(place) ? fits : too_large) = radius;
  }
  return fits;
}

/// Distance of a body from a wall of the convex vessel [m]: least at a corner.
double distance(const Body& body, const std::vector<Place>& corners,
    const model::Mill<double>& mill, int wall, const Instant<double>& when) {
  const auto pose = body.motion.pose(when);
  const auto of_vessel = mill.motion.pose(when);
  double least = INFINITY;
  for (const auto& corner : corners) {
    const Place place =
        mill.motion.position_in_vessel(of_vessel, body.motion.to_inertial(pose, corner));
    least = std::min(least, depth(mill.vessel, wall, place));
  }
  return least - body.shape.rounding();
}

/// The least of a gap between two times, and when.
struct Least {
  double gap = INFINITY, time = 0;
  bool joined = true;  ///< it has not been positive
};
/// @param change  the largest rate of the gap [m/s]
/// @param enough  parts where the gap is certainly larger are left
/// @param finest  to which the gap is known [m]
void search(const std::function<double(double)>& gap, double from, double to, double change,
    double enough, double finest, Least& least) {
  const double middle = (from + to) / 2, value = gap(middle);
  least.joined = least.joined && !(value > 0);
  if (value < least.gap) least = {value, middle, least.joined};
  const double possible = value - change * (to - from) / 2;
  if (possible > std::min(enough, std::max(least.gap, 0.0)) || change * (to - from) < finest)
    return;
  Interruption::check();
  search(gap, from, middle, change, enough, finest, least);
  search(gap, middle, to, change, enough, finest, least);
}

}  // namespace

double free_volume(const model::Mill<double>& mill, const Instant<double>& when) {
  if (mill.bodies.empty()) return mill.vessel.volume();
  constexpr int points = 20000;
  const auto pose = mill.motion.pose(when);
  std::vector<model::ChainPose<double>> poses;
  for (const auto& body : mill.bodies) poses.push_back(body.motion.pose(when));
  const Place half = mill.vessel.half_sizes();
  int inside = 0, outside_of_bodies = 0;
  for (int k = 1; k <= points; ++k) {
    const Place local{half[0] * (2 * radical_inverse(k, 2) - 1),
        half[1] * (2 * radical_inverse(k, 3) - 1), half[2] * (2 * radical_inverse(k, 5) - 1)};
    if (!mill.vessel.contains(local)) continue;
    ++inside;
    const Place place = mill.motion.to_inertial(pose, local);
    bool is_free = true;
    for (std::size_t b = 0; const auto& body : mill.bodies)
      is_free =
          is_free && body.shape.clearance(body.motion.position_in_vessel(poses[b++], place)) > 0;
    outside_of_bodies += is_free ? 1 : 0;
  }
  return inside > 0 ? mill.vessel.volume() * outside_of_bodies / inside : 0;
}

std::vector<NarrowGap> narrow_gaps(const CaseSpec& spec, const model::Mill<double>& mill) {
  std::vector<NarrowGap> found;
  const double diameter = spec.largest_diameter();
  if (mill.bodies.empty() || !(diameter > 0)) return found;
  const DriveClock<double> clock(mill.motion.period());
  double slowest = clock.period();
  bool slides = false;
  const auto look_at = [&](const auto& joints) {
    for (const auto& joint : joints) {
      slides = slides || (!joint.rotates && joint.speed != 0);
      if (joint.rotates && joint.speed != 0) slowest = std::max(slowest, 1 / std::abs(joint.speed));
      for (const auto& swing : joint.swings)
        if (swing.frequency != 0) slowest = std::max(slowest, 1 / std::abs(swing.frequency));
    }
  };
  for (const auto& body : mill.bodies) look_at(body.motion.joints().list);
  if (const auto* chain = mill.motion.get_if<model::ChainMotion<double>>())
    look_at(chain->joints().list);
  const double from = spec.initial_time.to<double>();
  double to = from + slowest;
  if (spec.end_time) {
    const double end = spec.end_time->to<double>();
    to = slides ? end : std::min(to, end);
  }
  // Two frames that do not move against each other are seen alike at all times.
  const auto moves = [&](const Body& body, const auto& other) {
    for (const double share : {0.137, 0.61})
      for (const auto& axis : {Place(0, 0, 0), Place(1, 0, 0), Place(0, 1, 0)}) {
        const auto at = [&](double time) -> Place {
          const auto when = clock.at(time);
          return other.position_in_vessel(
              other.pose(when), body.motion.to_inertial(body.motion.pose(when), axis));
        };
        if (norm<double>(Place(at(from) - at(from + share * (to - from)))) > 1e-9) return true;
      }
    return false;
  };
  const auto judge = [&](const Body& body, const std::string& other, double speed,
                         const auto& gap) {
    const double change = body.motion.wall_speed(body.shape.size()) + speed;
    Least least;
    const double finest = std::max(diameter / 200, change * (to - from) / 20000);
    search([&](double time) { return gap(clock.at(time)); }, from, to, change, diameter, finest,
        least);
    if (!least.joined && least.gap < diameter)
      found.push_back({body.name.label, other, std::max(least.gap, 0.0), least.time});
  };
  const bool rounded = mill.vessel.get_if<model::RoundedVessel<double>>() != nullptr;
  for (std::size_t k = 0; k < mill.bodies.size(); ++k) {
    const auto& body = mill.bodies[k];
    const auto corners = corners_of(body.shape);
    if (moves(body, mill.motion))
      for (int wall = 0; wall < (rounded ? 1 : mill.vessel.wall_count()); ++wall)
        judge(body, rounded ? "vessel" : mill.vessel.walls()[static_cast<std::size_t>(wall)].label,
            mill.motion.wall_speed(mill.vessel.reach()),
            [&](const auto& when) { return distance(body, corners, mill, wall, when); });
    for (std::size_t other = k + 1; other < mill.bodies.size(); ++other) {
      const auto& partner = mill.bodies[other];
      if (moves(body, partner.motion))
        judge(body, partner.name.label, partner.motion.wall_speed(partner.shape.size()),
            [&](const auto& when) { return distance(body, partner, when); });
    }
  }
  return found;
}

}  // namespace edmill::casefile
