#include "minimal_loop.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "periodic_gas.hpp"

namespace edmill::performance {

namespace {
constexpr double never = std::numeric_limits<double>::infinity();
}

EventHeap::EventHeap(int balls) {
  for (int i = 0; i < balls; ++i) {
    entries_.push_back({0, i});
    place_.push_back(i);
  }
}

void EventHeap::put(int place, const Entry& entry) {
  entries_[place] = entry;
  place_[entry.ball] = place;
}

void EventHeap::set(int ball, double time) {
  const int count = static_cast<int>(entries_.size());
  int place = place_[ball];
  while (place > 0 && time < entries_[(place - 1) / 2].time) {
    put(place, entries_[(place - 1) / 2]);
    place = (place - 1) / 2;
  }
  for (int child = 2 * place + 1; child < count; child = 2 * place + 1) {
    if (child + 1 < count && entries_[child + 1].time < entries_[child].time) ++child;
    if (time <= entries_[child].time) break;
    put(place, entries_[child]);
    place = child;
  }
  put(place, {time, ball});
}

void EventHeap::shift(double span) {
  for (auto& entry : entries_) entry.time -= span;
}

MinimalLoop::MinimalLoop(int balls, double packing, std::uint64_t seed, bool in_order)
    : heap_(balls) {
  const PeriodicGas gas(balls, packing, seed, in_order);
  box_ = gas.box;
  side_ = gas.cells_a_side();
  edge_ = box_ / side_;
  cells_.assign(static_cast<std::size_t>(side_) * side_ * side_, -1);
  balls_.resize(static_cast<std::size_t>(balls));
  for (int i = 0; i < balls; ++i) {
    Ball& ball = balls_[i];
    ball = {};
    ball.position = gas.positions[i];
    ball.velocity = gas.velocities[i];
    for (int k = 0; k < 3; ++k)
      ball.cell[k] = std::min(static_cast<int>(ball.position[k] / edge_), side_ - 1);
    enter_cell(i);
  }
  for (int i = 0; i < balls; ++i) predict(i);
}

void MinimalLoop::run(std::uint64_t collisions) {
  const auto end = collisions_ + collisions;
  while (collisions_ < end) {
    const int i = heap_.top();
    now_ = heap_.top_time();
    const Ball& ball = balls_[i];
    if (ball.crossing_time < ball.contact_time) {
      cross(i);
    } else if (balls_[ball.partner].impacts == ball.partner_impacts) {
      collide(i, ball.partner);
    } else {
      ++stale_;
      predict(i);
    }
    if (now_ > 128) restart_clock();
  }
}

void MinimalLoop::collide(int i, int j) {
  Ball &one = balls_[i], &two = balls_[j];
  advance(one);
  advance(two);
  Vector r;
  double b = 0, r2 = 0;
  for (int k = 0; k < 3; ++k) {
    r[k] = nearest_image(one.position[k] - two.position[k]);
    b += r[k] * (one.velocity[k] - two.velocity[k]);
    r2 += r[k] * r[k];
  }
  for (int k = 0; k < 3; ++k) {
    one.velocity[k] -= b / r2 * r[k];
    two.velocity[k] += b / r2 * r[k];
  }
  ++one.impacts;
  ++two.impacts;
  ++collisions_;
  predict(i);
  predict(j);
}

/// The contact that the ball has stays valid; only the nine cells that are new to it can bring an
/// earlier one.
void MinimalLoop::cross(int i) {
  ++crossings_;
  Ball& ball = balls_[i];
  const int axis = ball.axis, step = ball.step;
  leave_cell(i);
  advance(ball);
  const int to = wrapped(ball.cell[axis] + step);
  if (to != ball.cell[axis] + step) ball.position[axis] -= step * box_;
  ball.cell[axis] = to;
  enter_cell(i);
  std::array<int, 3> low, high;
  for (int k = 0; k < 3; ++k) {
    low[k] = ball.cell[k] + (k == axis ? step : -1);
    high[k] = ball.cell[k] + (k == axis ? step : 1);
  }
  predict_contacts(i, low, high);
  predict_crossing(ball);
  requeue(i);
}

void MinimalLoop::advance(Ball& ball) const {
  for (int k = 0; k < 3; ++k) ball.position[k] += ball.velocity[k] * (now_ - ball.time);
  ball.time = now_;
}

/// Predicts everything again, after a collision of the ball or of its expected partner.
void MinimalLoop::predict(int i) {
  Ball& ball = balls_[i];
  advance(ball);
  ball.contact_time = never;
  const auto& c = ball.cell;
  predict_contacts(i, {c[0] - 1, c[1] - 1, c[2] - 1}, {c[0] + 1, c[1] + 1, c[2] + 1});
  predict_crossing(ball);
  requeue(i);
}

/// Finds an earlier contact among the balls of the cells from `low` to `high`.
void MinimalLoop::predict_contacts(
    int i, const std::array<int, 3>& low, const std::array<int, 3>& high) {
  Ball& ball = balls_[i];
  for (int z = low[2]; z <= high[2]; ++z)
    for (int y = low[1]; y <= high[1]; ++y)
      for (int x = low[0]; x <= high[0]; ++x)
        for (int j = first_in({wrapped(x), wrapped(y), wrapped(z)}); j >= 0; j = balls_[j].next) {
          if (j == i) continue;
          const Ball& other = balls_[j];
          const double age = now_ - other.time;
          Vector r, v;
          double b = 0;
          for (int k = 0; k < 3; ++k) {
            r[k] = nearest_image(ball.position[k] - (other.position[k] + other.velocity[k] * age));
            v[k] = ball.velocity[k] - other.velocity[k];
            b += r[k] * v[k];
          }
          if (b >= 0) continue;
          const double v2 = v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
          const double c = r[0] * r[0] + r[1] * r[1] + r[2] * r[2] - 1;
          const double discriminant = b * b - v2 * c;
          if (discriminant < 0) continue;
          const double time = now_ + std::max(0.0, c / (std::sqrt(discriminant) - b));
          if (time < ball.contact_time) {
            ball.contact_time = time;
            ball.partner = j;
            ball.partner_impacts = other.impacts;
          }
        }
}

void MinimalLoop::predict_crossing(Ball& ball) const {
  ball.crossing_time = never;
  for (int k = 0; k < 3; ++k) {
    const double v = ball.velocity[k];
    const double face = (ball.cell[k] + (v > 0)) * edge_;
    const double time = now_ + std::max(0.0, (face - ball.position[k]) / v);
    if (time < ball.crossing_time) {
      ball.crossing_time = time;
      ball.axis = k;
      ball.step = v > 0 ? 1 : -1;
    }
  }
}

void MinimalLoop::enter_cell(int i) {
  Ball& ball = balls_[i];
  int& first = first_in(ball.cell);
  ball.previous = -1;
  ball.next = first;
  if (first >= 0) balls_[first].previous = i;
  first = i;
}

void MinimalLoop::leave_cell(int i) {
  const Ball& ball = balls_[i];
  if (ball.next >= 0) balls_[ball.next].previous = ball.previous;
  (ball.previous >= 0 ? balls_[ball.previous].next : first_in(ball.cell)) = ball.next;
}

/// Keeps times small, so that they keep their digits.
void MinimalLoop::restart_clock() {
  for (auto& ball : balls_) {
    ball.time -= now_;
    ball.contact_time -= now_;
    ball.crossing_time -= now_;
  }
  heap_.shift(now_);
  past_ += now_;
  now_ = 0;
}

double MinimalLoop::kinetic_energy() const {
  double twice = 0;
  for (const auto& ball : balls_)
    for (const double v : ball.velocity) twice += v * v;
  return twice / 2;
}

std::vector<std::array<double, 3>> MinimalLoop::positions() const {
  std::vector<Vector> result;
  for (Ball ball : balls_) {
    advance(ball);
    result.push_back(ball.position);
  }
  return result;
}

}  // namespace edmill::performance
