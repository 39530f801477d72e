#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "base/statistics.hpp"
#include "dem/contacts.hpp"

namespace edmill::dem {

namespace {

using Class = ContactClass;

/// Longest stretch in frames. Longer ones are cut, which bounds the memory for a ball at rest.
constexpr std::size_t longest_stretch = 4096;
/// Number of intervals in which flights between two frames are sampled.
constexpr int tried = 32;

/// Change of a ball's velocity between two frames, without that by gravity [m/s].
double change_of(const Frame& from, const Frame& to, std::size_t ball, const Vector& gravity) {
  return norm(Vector(
      to.balls[ball].velocity - from.balls[ball].velocity - gravity * (to.time - from.time)));
}

/// Time at which a gap first falls to zero, or last rises from it; nothing if it does not.
std::optional<double> crossing(const auto& gap, double low, double high, bool falling) {
  for (int round = 0; round < 4; ++round) {
    std::array<double, tried + 1> places, values;
    for (int k = 0; k <= tried; ++k) {
      const auto place = k;
      places[place] = low + (high - low) * k / tried;
      values[place] = gap(places[place]);
    }
    std::size_t found = 0;
    for (std::size_t k = 1; k <= tried && !(falling && found > 0); ++k)
      if ((values[k - 1] > 0) == falling && (values[k] > 0) != falling) found = k;
    if (found == 0) return std::nullopt;
    low = places[found - 1];
    high = places[found];
  }
  const double one = gap(low), other = gap(high);
  return one == other ? low : low + (high - low) * one / (one - other);
}

/// Gravity is the median acceleration: balls fly freely most of the time. Longer spans reduce the
/// effect of rounding, until most contain contacts; the span with the least scatter is used. The
/// interval includes the scatter of a single value, because rounding errors do not average out.
void set_gravity(const std::vector<Frame>& frames, FrameStatistics& s) {
  double least = std::numeric_limits<double>::infinity();
  for (const std::size_t span : {1u, 10u, 100u}) {
    if (span >= frames.size()) break;
    Vector gravity, half_width;
    double scatter = 0;
    for (int axis = 0; axis < 3; ++axis) {
      std::vector<double> accelerations, off;
      for (std::size_t k = span; k < frames.size(); ++k)
        for (std::size_t i = 0; i < frames[k].balls.size(); ++i)
          accelerations.push_back(
              (frames[k].balls[i].velocity[axis] - frames[k - span].balls[i].velocity[axis]) /
              (frames[k].time - frames[k - span].time));
      gravity[axis] = numerics::median_of(accelerations).value;
      for (const double value : accelerations) off.push_back(std::abs(value - gravity[axis]));
      const double one = 1.4826 * numerics::median_of(std::move(off)).value;
      half_width[axis] =
          one + 1.96 * 1.2533 * one / std::sqrt(static_cast<double>(accelerations.size()));
      scatter = std::max(scatter, one);
    }
    if (scatter >= least) continue;
    least = scatter;
    s.gravity = gravity;
    s.gravity_half_width = half_width;
  }
}

}  // namespace

FrameStatistics statistics_of(const std::vector<Frame>& frames, const Vector& expected_gravity) {
  EDMILL_REQUIRE(frames.size() > 2, "three frames");
  FrameStatistics s;
  const std::size_t balls = frames[0].balls.size();
  std::vector<double> intervals;
  for (std::size_t k = 1; k < frames.size(); ++k)
    intervals.push_back(frames[k].time - frames[k - 1].time);
  s.interval = numerics::median_of(intervals).value;
  set_gravity(frames, s);
  const Vector off = (s.gravity - expected_gravity).cwiseAbs(), known_to = 3 * s.gravity_half_width;
  if ((off.array() <= known_to.array() + 1e-6).all()) s.gravity = expected_gravity;
  std::vector<double> changes, ways;
  for (std::size_t k = 1; k < frames.size(); ++k)
    for (std::size_t i = 0; i < balls; ++i) {
      changes.push_back(change_of(frames[k - 1], frames[k], i, s.gravity));
      const auto &a = frames[k - 1].balls[i], &b = frames[k].balls[i];
      const Vector due = (a.velocity + b.velocity) * ((frames[k].time - frames[k - 1].time) / 2),
                   way = b.position - a.position;
      if (const double square = dot(due, due); square > 0) ways.push_back(dot(way, due) / square);
    }
  s.way_factor = numerics::median_of(std::move(ways)).value;
  std::sort(changes.begin(), changes.end());
  s.kick = std::clamp(20 * changes[changes.size() / 4], 2e-5, 1e-2);
  std::vector<double> stretches;
  for (std::size_t i = 0; i < balls; ++i) {
    double since = -1;
    for (std::size_t k = 1; k < frames.size(); ++k) {
      const bool kicked = change_of(frames[k - 1], frames[k], i, s.gravity) > s.kick;
      if (kicked && since < 0) since = frames[k - 1].time;
      if (!kicked && since >= 0) {
        stretches.push_back(frames[k - 1].time - since);
        since = -1;
      }
    }
  }
  s.contact_time = stretches.empty() ? s.interval : numerics::median_of(stretches).value;
  return s;
}

ContactFinder::ContactFinder(const MovingVessel& vessel, const FrameStatistics& frames, Found found)
    : vessel_(vessel), frames_(frames), found_(std::move(found)),
      open_of_(vessel.ball_count(), -1) {
  for (std::size_t ball = 0; ball < vessel.ball_count(); ++ball)
    largest_radius_ = std::max(largest_radius_, vessel.ball(ball).radius);
}

void ContactFinder::add(Frame next) {
  window_.push_back(std::move(next));
  const std::size_t now = first_ + window_.size() - 1;
  if (window_.size() < 2) return;
  std::vector<std::size_t> ended;
  std::vector<bool> flies(open_of_.size());
  for (std::size_t ball = 0; ball < open_of_.size(); ++ball) {
    int& open = open_of_[ball];
    flies[ball] = change_of(frame(now - 1), frame(now), ball, frames_.gravity) <= frames_.kick;
    if (!flies[ball] && open < 0) {
      open = static_cast<int>(stretches_.size());
      stretches_.push_back({ball, now - 1, now, groups_++});
    } else if (!flies[ball]) {
      auto& stretch = stretches_[open];
      stretch.last = now;
      if (now - stretch.first >= longest_stretch) ended.push_back(ball);
    } else if (open >= 0) {
      ended.push_back(ball);
    }
  }
  for (const std::size_t ball : ended) close(stretches_[open_of_[ball]]);
  if (!ended.empty()) settle();
  find_jumps();
  watch_overlaps(flies);
  std::size_t needed = now;
  for (const auto& stretch : stretches_) needed = std::min(needed, stretch.first);
  for (; first_ < needed; ++first_) window_.pop_front();
}

/// Reports balls that moved farther in an interval than the velocities at its ends allow.
void ContactFinder::find_jumps() {
  const std::size_t now = first_ + window_.size() - 1;
  const Frame &from = frame(now - 1), &to = frame(now);
  const double dt = to.time - from.time;
  for (std::size_t ball = 0; ball < open_of_.size(); ++ball) {
    const auto &a = from.balls[ball], &b = to.balls[ball];
    const double way = norm(b.position - a.position);
    const double fastest = norm(a.velocity) + norm(b.velocity);
    if (way <= fastest * dt + vessel_.ball(ball).radius / 10) continue;
    found_({.kind = Class::jump,
        .begin = from.time,
        .end = to.time,
        .free_until = from.time,
        .free_from = to.time,
        .ball = static_cast<int>(ball),
        .before = a,
        .after = b});
  }
}

void ContactFinder::watch_overlaps(const std::vector<bool>& flies) {
  const Frame &before = window_[window_.size() - 2], &now = window_.back();
  std::map<BodyPair, Overlap> present;
  const auto watch = [&](const BodyPair& bodies, double depth) {
    if (!(depth > 0)) return;
    const auto known = overlaps_.extract(bodies);
    auto& overlap = present[bodies] = known ? known.mapped() : Overlap{before.time};
    overlap.growth = std::max(overlap.growth, (depth - overlap.last) / (now.time - before.time));
    overlap.depth = std::max(overlap.depth, depth);
    overlap.last = depth;
  };
  const auto pose = vessel_.at(now.time);
  const int count = static_cast<int>(open_of_.size());
  for (int ball = 0; ball < count; ++ball)
    for (int wall = 0; wall < vessel_.walls(); ++wall)
      watch({ball, -1 - wall}, -vessel_.gap(pose, ball, wall, now.balls[ball].position));
  // Sweep over the balls in the order of x, in which overlapping balls are near each other.
  std::vector<int> order(open_of_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(),
      [&](int a, int b) { return now.balls[a].position[0] < now.balls[b].position[0]; });
  for (auto one = order.begin(); one != order.end(); ++one)
    for (auto two = std::next(one); two != order.end(); ++two) {
      const Vector apart = now.balls[*two].position - now.balls[*one].position;
      if (apart[0] > vessel_.ball(*one).radius + largest_radius_) break;
      const double touch = vessel_.ball(*one).radius + vessel_.ball(*two).radius;
      watch({std::min(*one, *two), std::max(*one, *two)}, touch - norm(apart));
    }
  for (auto* list : {&present, &overlaps_})
    for (auto& [bodies, overlap] : *list)
      for (std::size_t k = 0; k < 2; ++k)
        overlap.flies[k] = overlap.flies[k] && bodies[k] >= 0 && flies[bodies[k]];
  for (const auto& [bodies, overlap] : overlaps_) end_overlap(bodies, overlap);
  overlaps_ = std::move(present);
}

/// Reports an overlap that was not a contact: a contact changes the velocities of both balls, and
/// its depth is less than a third of its duration times the approach speed. Overlaps below a
/// thousandth of the radius may be noise. A ball whose centre is outside is always reported.
void ContactFinder::end_overlap(const BodyPair& bodies, const Overlap& overlap) {
  const double radius = vessel_.ball(bodies[0]).radius;
  const double most = std::clamp(overlap.growth * frames_.contact_time, 1e-3 * radius, radius / 5);
  const bool flies_on = overlap.depth > most && (overlap.flies[0] || overlap.flies[1]);
  if (!flies_on && overlap.depth < radius) return;
  Contact contact;
  contact.kind = Class::missed;
  contact.begin = contact.free_until = overlap.begin;
  contact.end = contact.free_from = window_.back().time;
  contact.ball = bodies[0];
  contact.bodies = bodies[1] < 0 ? 1 : 2;
  contact.partner = bodies[1] < 0 ? -1 - bodies[1] : bodies[1];
  contact.before = contact.after = window_.back().balls[bodies[0]];
  found_(contact);
}

void ContactFinder::finish() {
  at_end_ = true;
  for (const auto& [bodies, overlap] : overlaps_) end_overlap(bodies, overlap);
  for (auto& stretch : stretches_)
    if (stretch.open) close(stretch);
  settle();
}

void ContactFinder::close(Stretch& stretch) {
  stretch.open = false;
  for (auto& other : stretches_)
    if (other.group != stretch.group && other.first < stretch.last && stretch.first < other.last &&
        come_near(stretch, other))
      for (const int from = other.group; auto& joined : stretches_)
        if (joined.group == from) joined.group = stretch.group;
}

bool ContactFinder::come_near(const Stretch& one, const Stretch& other) const {
  const std::size_t low = std::max(one.first, other.first), high = std::min(one.last, other.last);
  const auto &a = vessel_.ball(one.ball), &b = vessel_.ball(other.ball);
  const double touch = (a.radius + b.radius) * (1 + 1e-9);
  double nearest = std::numeric_limits<double>::infinity(), fastest = 0;
  for (std::size_t k = low; k <= high; ++k) {
    const auto &i = frame(k).balls[one.ball], &j = frame(k).balls[other.ball];
    nearest = std::min(nearest, norm(i.position - j.position));
    fastest = std::max(fastest, norm(i.velocity - j.velocity));
  }
  if (nearest <= touch) return true;
  const double whole = frame(high).time - frame(low).time;
  if ((high - low > 2 && resolved()) || nearest > touch + 2 * fastest * whole) return false;
  // Between two frames, extrapolate forwards from the first and backwards from the second.
  const auto meet = [&](std::size_t from, double step) {
    const auto &i = frame(from).balls[one.ball], &j = frame(from).balls[other.ball];
    for (int k = 0; k <= tried; ++k) {
      const Vector apart = i.position - j.position + (i.velocity - j.velocity) * (step * k / tried);
      if (norm(apart) <= touch) return true;
    }
    return false;
  };
  if (high - low <= 2 && (meet(low, whole) || meet(high, -whole))) return true;
  for (std::size_t k = low; k < high; ++k) {
    const double step = frame(k + 1).time - frame(k).time;
    if (meet(k, step) || meet(k + 1, -step)) return true;
  }
  return false;
}

void ContactFinder::settle() {
  for (std::size_t k = 0; k < stretches_.size();) {
    const auto in_group = [group = stretches_[k].group](auto& s) { return s.group == group; };
    Group members;
    std::copy_if(stretches_.begin(), stretches_.end(), std::back_inserter(members), in_group);
    if (std::any_of(members.begin(), members.end(), [](const auto& one) { return one.open; })) {
      ++k;
      continue;
    }
    std::erase_if(stretches_, in_group);
    report(std::move(members));
  }
  std::fill(open_of_.begin(), open_of_.end(), -1);
  for (std::size_t k = 0; k < stretches_.size(); ++k)
    if (stretches_[k].open) open_of_[stretches_[k].ball] = static_cast<int>(k);
}

/// Walls that a ball overlaps during a stretch, listed once per encounter.
std::vector<int> ContactFinder::walls_met(const Stretch& s) const {
  std::vector<int> met;
  std::vector<bool> inside(vessel_.walls());
  const auto see = [&](const auto& gap_from) {
    for (int wall = 0; wall < vessel_.walls(); ++wall) {
      const bool under = gap_from(wall) < 0;
      if (under && !inside[wall]) met.push_back(wall);
      inside[wall] = under;
    }
  };
  const auto see_flights = [&](const Frame& from, const Frame& to) {
    for (int k = 0; k <= tried; ++k) {
      const double t = from.time + (to.time - from.time) * k / tried;
      const auto pose = vessel_.at(t);
      const Vector on = flown(from.balls[s.ball], frames_.gravity, t - from.time).position,
                   back = flown(to.balls[s.ball], frames_.gravity, t - to.time).position;
      see([&](int wall) {
        return std::min(vessel_.gap(pose, s.ball, wall, on), vessel_.gap(pose, s.ball, wall, back));
      });
    }
  };
  if (s.last - s.first <= 2)
    see_flights(frame(s.first), frame(s.last));
  else if (resolved())
    for (std::size_t k = s.first; k <= s.last; ++k)
      see([&, pose = vessel_.at(frame(k).time)](int wall) {
        return vessel_.gap(pose, s.ball, wall, frame(k).balls[s.ball].position);
      });
  else
    for (std::size_t k = s.first; k < s.last; ++k) see_flights(frame(k), frame(k + 1));
  return met;
}

/// Energy relative to a frame that a ball loses along a sequence of states [J].
double ContactFinder::balance(std::size_t frame, std::size_t ball, const States& states) const {
  auto pose = vessel_.at(states.front().first);
  double lost = vessel_.energy(pose, frame, ball, states.front().second);
  for (std::size_t k = 1; k < states.size(); ++k) {
    const auto next = vessel_.at(states[k].first);
    lost += vessel_.work(
        pose, states[k - 1].second, next, states[k].second, frame, ball, frames_.gravity);
    pose = next;
  }
  return lost - vessel_.energy(pose, frame, ball, states.back().second);
}

/// The energy that balls lose relative to what they touch [J]. Where a ball touches walls that move
/// differently, it is that relative to the vessel, with the work of the bodies.
double ContactFinder::dose_of(const Group& group) const {
  std::vector<std::vector<int>> met(group.size());
  std::vector<std::size_t> touched;
  for (std::size_t k = 0; k < group.size() && vessel_.has_bodies(); ++k) {
    met[k] = walls_met(group[k]);
    std::sort(met[k].begin(), met[k].end());
    met[k].erase(std::unique(met[k].begin(), met[k].end()), met[k].end());
    for (const int wall : met[k]) touched.push_back(vessel_.frame_of(wall));
  }
  const bool alike = std::count(touched.begin(), touched.end(), touched.empty() ? 0 : touched[0]) ==
      std::ssize(touched);
  double dose = 0;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const auto& s = group[k];
    States states;
    for (std::size_t f = s.first; f <= s.last; ++f)
      states.emplace_back(frame(f).time, frame(f).balls[s.ball]);
    dose += balance(alike && !touched.empty() ? touched[0] : 0, s.ball, states);
    if (!alike) dose += work_of_bodies(s, met[k]);
  }
  return dose;
}

/// Work of bodies on a ball, relative to the vessel, by its impulse along their normals [J].
double ContactFinder::work_of_bodies(const Stretch& s, const std::vector<int>& walls) const {
  if (walls.empty()) return 0;
  double work = 0;
  for (std::size_t f = s.first; f < s.last; ++f) {
    const auto &from = frame(f), &to = frame(f + 1);
    const auto& ball = to.balls[s.ball];
    const auto pose = vessel_.at(to.time);
    Eigen::MatrixXd normals(3, std::ssize(walls));
    for (std::size_t w = 0; w < walls.size(); ++w)
      normals.col(w) = vessel_.normal(pose, s.ball, walls[w], ball.position);
    const Vector push =
        (ball.velocity - from.balls[s.ball].velocity - frames_.gravity * (to.time - from.time)) *
        vessel_.ball(s.ball).mass;
    const Eigen::VectorXd parts = normals.colPivHouseholderQr().solve(push);
    for (std::size_t w = 0; w < walls.size(); ++w) {
      const Vector n = normals.col(w);
      const Vector faster = vessel_.wall_velocity(pose, walls[w], ball.position) -
          vessel_.wall_velocity(pose, 0, ball.position);
      work += std::max(0.0, parts[w]) * dot(n, faster);
    }
  }
  return work;
}

bool ContactFinder::make_single(const Group& group, int wall, Contact& contact) const {
  const auto& a = group[0];
  const Frame &from = frame(a.first), &to = frame(a.last);
  const auto gap_of = [&](const Frame& known) {
    return [&, this](double t) {
      const auto own = flown(known.balls[a.ball], frames_.gravity, t - known.time).position;
      if (wall >= 0) return vessel_.gap(vessel_.at(t), a.ball, wall, own);
      const auto ball = group[1].ball;
      const auto other = flown(known.balls[ball], frames_.gravity, t - known.time).position;
      return norm(own - other) - vessel_.ball(a.ball).radius - vessel_.ball(ball).radius;
    };
  };
  const double longest = to.time - from.time;
  // Some codes' velocities are half a step old: the touch may precede the last frame of a flight.
  const auto touch = crossing(gap_of(from), from.time - frames_.interval, to.time, true);
  const auto leave = crossing(gap_of(to), from.time, to.time + 2 * longest, false);
  // In codes whose contacts have no duration, rounding may put the detachment before the touch.
  if (!touch || !leave || *leave < *touch - frames_.interval / 100) return false;
  const double middle = (*touch + *leave) / 2;
  contact.begin = std::min(*touch, middle);
  contact.end = std::max(*leave, middle);
  contact.dose = 0;
  for (std::size_t k = 0; k < group.size(); ++k) {
    const std::size_t ball = group[k].ball;
    const auto before = flown(from.balls[ball], frames_.gravity, contact.begin - from.time);
    const auto after = flown(to.balls[ball], frames_.gravity, contact.end - to.time);
    States states{{contact.begin, before}};
    for (std::size_t f = a.first + 1; f < a.last; ++f)
      if (frame(f).time > contact.begin && frame(f).time < contact.end)
        states.emplace_back(frame(f).time, frame(f).balls[ball]);
    states.emplace_back(contact.end, after);
    contact.dose += balance(wall >= 0 ? vessel_.frame_of(wall) : 0, ball, states);
    (k == 0 ? contact.before : contact.partner_before) = before;
    (k == 0 ? contact.after : contact.partner_after) = after;
  }
  return true;
}

void ContactFinder::report(Group group) {
  std::sort(group.begin(), group.end(), [](auto& a, auto& b) { return a.ball < b.ball; });
  Contact contact;
  std::size_t first = group[0].first, last = group[0].last;
  for (const auto& s : group) {
    first = std::min(first, s.first);
    last = std::max(last, s.last);
  }
  contact.dose = dose_of(group);
  contact.free_until = contact.begin = frame(first).time;
  contact.free_from = contact.end = frame(last).time;
  contact.bodies = static_cast<int>(group.size());
  contact.ball = static_cast<int>(group[0].ball);
  contact.before = frame(group[0].first).balls[group[0].ball];
  contact.after = frame(group[0].last).balls[group[0].ball];
  contact.kind = Class::several;
  const double duration = contact.free_from - contact.free_until;
  const bool lasts = first == 0 || duration > 3 * frames_.contact_time + 2 * frames_.interval;
  if (at_end_ && !lasts) return;
  const auto impulse = [&](const Stretch& s) {
    const double dt = frame(s.last).time - frame(s.first).time;
    return Vector(vessel_.ball(s.ball).mass *
        (frame(s.last).balls[s.ball].velocity - frame(s.first).balls[s.ball].velocity -
            frames_.gravity * dt));
  };
  if (group.size() == 1) {
    const auto met = walls_met(group[0]);
    // A change this small is due to rounded numbers in the dump, not to a contact.
    const double change = norm(impulse(group[0])) / vessel_.ball(group[0].ball).mass;
    if (met.empty() && change < std::max(50 * frames_.kick, 1e-3)) return;
    if (met.empty())
      contact.kind = Class::unexplained;
    else if (std::count(met.begin(), met.end(), met[0]) == std::ssize(met))
      contact.partner = met[0];
    if (lasts && !met.empty())
      contact.kind = Class::lasting;
    else if (met.size() == 1)
      contact.kind = make_single(group, met[0], contact) ? Class::wall : Class::unexplained;
  } else if (group.size() == 2) {
    const auto &a = group[0], &b = group[1];
    const Vector of_a = impulse(a), of_b = impulse(b);
    const bool alone =
        a.first == b.first && a.last == b.last && norm(of_a + of_b) < 0.01 * norm(of_a);
    if (alone) contact.partner = static_cast<int>(b.ball);
    if (alone && lasts) contact.kind = Class::lasting;
    if (alone && !lasts && make_single(group, -1, contact)) contact.kind = Class::pair;
  }
  found_(contact);
}

}  // namespace edmill::dem
