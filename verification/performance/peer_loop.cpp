#include "peer_loop.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "periodic_gas.hpp"

namespace edmill::performance {

void Calendar::open(int balls, double day) {
  entries_.resize(static_cast<std::size_t>(balls));
  days_ = std::max(64, 8 * balls);
  heads_.assign(static_cast<std::size_t>(days_) + 1, -1);
  per_day_ = 1 / day;
  year_ = days_ * day;
  today_ = 0;
}

int Calendar::first() {
  while (heads_[today_] < 0) {
    if (++today_ == days_) return -1;
  }
  int best = heads_[today_];
  for (int k = entries_[best].next; k >= 0; k = entries_[k].next)
    if (entries_[k].time < entries_[best].time) best = k;
  return best;
}

void Calendar::add(int ball, double time) {
  const double exact = time * per_day_;
  int day = days_;
  if (exact < days_) day = std::max(static_cast<int>(exact), today_);
  const int head = heads_[day];
  entries_[ball] = {time, head, -2 - day};
  if (head >= 0) entries_[head].previous = ball;
  heads_[day] = ball;
}

void Calendar::unlink(int ball) {
  const Entry& e = entries_[ball];
  if (e.next >= 0) entries_[e.next].previous = e.previous;
  (e.previous >= 0 ? entries_[e.previous].next : heads_[-2 - e.previous]) = e.next;
}

PeerLoop::PeerLoop(int balls, double packing, std::uint64_t seed, bool in_order) {
  const PeriodicGas gas(balls, packing, seed, in_order);
  box_ = gas.box;
  side_ = gas.cells_a_side();
  edge_ = box_ / side_;
  balls_.resize(static_cast<std::size_t>(balls));
  for (int i = 0; i < balls; ++i) balls_[i] = {gas.positions[i], gas.velocities[i], 0, 0, 0};
  cells_.resize(static_cast<std::size_t>(side_) * side_ * side_);
  for (int i = 0; i < balls; ++i) {
    for (int k = 0; k < 3; ++k) {
      const int place = std::min(static_cast<int>(balls_[i].position[k] / edge_), side_ - 1);
      balls_[i].cell |= static_cast<std::uint32_t>(place) << (10 * k);
    }
    enter(index(balls_[i].cell), i);
  }
  candidates_.resize(static_cast<std::size_t>(balls) + 27 * Cell::capacity);
  near_.resize(candidates_.size());
  agendas_.resize(balls_.size());
  day_ = 1 / (balls * (enskog_rate(packing) + 2.4 / edge_));
  calendar_.open(balls, day_);
  for (int i = 0; i < balls; ++i) {
    predict_pairs(i, balls_[i].position);
    predict_crossing(i, balls_[i].position);
    calendar_.add(i, next_time(i));
  }
}

void PeerLoop::run(std::uint64_t collisions) {
  const auto end = collisions_ + collisions;
  while (collisions_ < end) step();
}

void PeerLoop::step() {
  int i = calendar_.first();
  if (i < 0) {
    next_year();
    return;
  }
  now_ = calendar_.time(i);
  Agenda& a = agendas_[i];
  if (a.count == 0 || a.crossing_time <= a.contacts[0].time) return cross(i);
  if (balls_[a.contacts[0].partner].impacts == a.contacts[0].partner_impacts)
    return collide(i, a.contacts[0].partner);
  // The partner has collided since: the next contact that holds takes its place.
  ++stale_;
  int stale = 1;
  while (stale < a.count &&
      balls_[a.contacts[stale].partner].impacts != a.contacts[stale].partner_impacts)
    ++stale;
  for (int k = stale; k < a.count; ++k) a.contacts[k - stale] = a.contacts[k];
  a.count = static_cast<std::uint8_t>(a.count - stale);
  if (a.count == 0 && a.dropped) predict_pairs(i, position_now(balls_[i]));
  requeue(i);
}

void PeerLoop::collide(int i, int j) {
  Ball &one = balls_[i], &two = balls_[j];
  one.position = position_now(one);
  two.position = position_now(two);
  one.time = two.time = now_;
  Vector r;
  double b = 0, r2 = 0;
  for (int k = 0; k < 3; ++k) {
    r[k] = one.position[k] - two.position[k];
    if (r[k] > box_ / 2) r[k] -= box_;
    if (r[k] < -box_ / 2) r[k] += box_;
    b += r[k] * (one.velocity[k] - two.velocity[k]);
    r2 += r[k] * r[k];
  }
  const double impulse = b / r2;
  for (int k = 0; k < 3; ++k) {
    one.velocity[k] -= impulse * r[k];
    two.velocity[k] += impulse * r[k];
  }
  ++one.impacts;
  ++two.impacts;
  ++collisions_;
  for (const int ball : {i, j}) {
    predict_pairs(ball, balls_[ball].position);
    predict_crossing(ball, balls_[ball].position);
    requeue(ball);
  }
}

/// The ball keeps its flight; when it leaves through a face of the box, the whole flight moves
/// over.
void PeerLoop::cross(int i) {
  ++crossings_;
  Ball& ball = balls_[i];
  const int axis = agendas_[i].axis, step = agendas_[i].step;
  leave(index(ball.cell), i);
  const auto wrapped = [&](int place) {
    return place < 0 ? side_ - 1 : place == side_ ? 0 : place;
  };
  const auto with = [&](std::uint32_t cell, int place) {
    return (cell & ~(1023U << (10 * axis))) | (static_cast<std::uint32_t>(place) << (10 * axis));
  };
  const int from = coordinate(ball.cell, axis), to = wrapped(from + step);
  if (to != from + step) ball.position[axis] -= step * box_;
  ball.cell = with(ball.cell, to);
  enter(index(ball.cell), i);

  const Vector position = position_now(ball);
  // The nine cells beyond the new one.
  const std::uint32_t beyond = with(ball.cell, wrapped(to + step));
  const int one = (axis + 1) % 3, two = (axis + 2) % 3;
  const std::array<int, 3> stride{1, side_, side_ * side_};
  const int a = coordinate(beyond, one), b = coordinate(beyond, two);
  const int base = coordinate(beyond, axis) * stride[axis];
  int* end = candidates_.data();
  for (int v = b - 1; v <= b + 1; ++v)
    for (int u = a - 1; u <= a + 1; ++u)
      end = gather(base + wrapped(u) * stride[one] + wrapped(v) * stride[two], end);
  const auto inner = [&](int place) { return place > 0 && place < side_ - 1; };
  if (inner(a) && inner(b) && inner(to))
    consider<false>(i, position, candidates_.data(), end);
  else
    consider<true>(i, position, candidates_.data(), end);
  predict_crossing(i, position);
  requeue(i);
}

void PeerLoop::predict_pairs(int i, const Vector& position) {
  Agenda& a = agendas_[i];
  a.count = 0;
  a.dropped = false;
  const auto cell = balls_[i].cell;
  const int x = coordinate(cell, 0), y = coordinate(cell, 1), z = coordinate(cell, 2);
  const auto inner = [&](int place) { return place > 0 && place < side_ - 1; };
  int* end = candidates_.data();
  if (inner(x) && inner(y) && inner(z)) {
    for (int w = z - 1; w <= z + 1; ++w)
      for (int v = y - 1; v <= y + 1; ++v) {
        const int row = (w * side_ + v) * side_ + x;
        end = gather(row - 1, end);
        end = gather(row, end);
        end = gather(row + 1, end);
      }
    return consider<false>(i, position, candidates_.data(), end);
  }
  const auto wrapped = [&](int place) {
    return place < 0 ? side_ - 1 : place == side_ ? 0 : place;
  };
  for (int w = z - 1; w <= z + 1; ++w)
    for (int v = y - 1; v <= y + 1; ++v)
      for (int u = x - 1; u <= x + 1; ++u)
        end = gather((wrapped(w) * side_ + wrapped(v)) * side_ + wrapped(u), end);
  consider<true>(i, position, candidates_.data(), end);
}

/// Two passes: the first sorts out without a branch who comes near, the second times those. The
/// ball itself is among the candidates: it does not approach itself.
template <bool at_edge>
void PeerLoop::consider(int i, const Vector& position, const int* first, const int* last) {
  const Vector own = balls_[i].velocity;
  const double half = box_ / 2;
  Near* end = near_.data();
  for (; first != last; ++first) {
    const Ball& other = balls_[*first];
    const double age = now_ - other.time;
    double b = 0, r2 = 0, v2 = 0;
    for (int k = 0; k < 3; ++k) {
      double r = position[k] - (other.position[k] + other.velocity[k] * age);
      if (at_edge) r -= r > half ? box_ : r < -half ? -box_ : 0;
      const double v = own[k] - other.velocity[k];
      b += r * v;
      r2 += r * r;
      v2 += v * v;
    }
    const double c = r2 - 1, discriminant = b * b - v2 * c;
    *end = {b, c, discriminant, *first};
    end += (b < 0) & (discriminant > 0);
  }
  Agenda& agenda = agendas_[i];
  for (const Near* n = near_.data(); n != end; ++n) {
    const double delay = std::max(0.0, n->c / (std::sqrt(n->discriminant) - n->b));
    keep(agenda, {now_ + delay, n->ball, balls_[n->ball].impacts});
  }
}

void PeerLoop::keep(Agenda& a, const Contact& found) {
  int place = a.count;
  while (place > 0 && found.time < a.contacts[place - 1].time) --place;
  if (a.count == Agenda::capacity) {
    a.dropped = true;
    if (place == a.count) return;
  } else {
    ++a.count;
  }
  for (int k = a.count - 1; k > place; --k) a.contacts[k] = a.contacts[k - 1];
  a.contacts[place] = found;
}

void PeerLoop::predict_crossing(int i, const Vector& position) {
  const Ball& ball = balls_[i];
  Agenda& a = agendas_[i];
  double best = std::numeric_limits<double>::infinity();
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    const double v = ball.velocity[k];
    const double delay = ((coordinate(ball.cell, k) + (v > 0)) * edge_ - position[k]) / v;
    if (delay < best) {
      best = delay;
      axis = k;
    }
  }
  a.axis = static_cast<std::int8_t>(axis);
  a.step = ball.velocity[axis] > 0 ? 1 : -1;
  a.crossing_time = now_ + std::max(0.0, best);
}

double PeerLoop::next_time(int i) const {
  const Agenda& a = agendas_[i];
  return a.count == 0 ? a.crossing_time : std::min(a.crossing_time, a.contacts[0].time);
}

PeerLoop::Vector PeerLoop::position_now(const Ball& b) const {
  const double age = now_ - b.time;
  return {b.position[0] + b.velocity[0] * age, b.position[1] + b.velocity[1] * age,
      b.position[2] + b.velocity[2] * age};
}

void PeerLoop::enter(int cell, int ball) {
  Cell& c = cells_[cell];
  if (c.count < Cell::capacity)
    c.balls[c.count] = ball;
  else
    spill_.push_back({cell, ball});
  ++c.count;
}

void PeerLoop::leave(int cell, int ball) {
  Cell& c = cells_[cell];
  const int kept = std::min(c.count, Cell::capacity);
  const int place =
      static_cast<int>(std::find(c.balls.begin(), c.balls.begin() + kept, ball) - c.balls.begin());
  if (c.count > Cell::capacity) {
    // A spilled ball takes the free place, or is the one that leaves.
    const auto spilled = std::find_if(spill_.begin(), spill_.end(),
        [&](const Spilled& s) { return s.cell == cell && (place < kept || s.ball == ball); });
    if (place < kept) c.balls[place] = spilled->ball;
    *spilled = spill_.back();
    spill_.pop_back();
  } else {
    c.balls[place] = c.balls[kept - 1];
  }
  --c.count;
}

/// Appends the balls of a cell: four at a time without a branch, since most cells hold fewer.
int* PeerLoop::gather(int cell, int* end) const {
  const Cell& c = cells_[cell];
  std::memcpy(end, c.balls.data(), 4 * sizeof(int));
  if (c.count > 4) [[unlikely]] {
    std::memcpy(end + 4, c.balls.data() + 4, 3 * sizeof(int));
    if (c.count > Cell::capacity) {
      int* out = end + Cell::capacity;
      for (const auto& s : spill_)
        if (s.cell == cell) *out++ = s.ball;
    }
  }
  return end + c.count;
}

void PeerLoop::next_year() {
  const double year = calendar_.year();
  for (auto& b : balls_) b.time -= year;
  for (auto& a : agendas_) {
    a.crossing_time -= year;
    for (auto& c : a.contacts) c.time -= year;
  }
  now_ -= year;
  years_ += year;
  const int count = static_cast<int>(balls_.size());
  calendar_.open(count, day_);
  for (int i = 0; i < count; ++i) calendar_.add(i, next_time(i));
}

double PeerLoop::kinetic_energy() const {
  double twice = 0;
  for (const auto& b : balls_)
    for (const double v : b.velocity) twice += v * v;
  return twice / 2;
}

std::vector<std::array<double, 3>> PeerLoop::positions() const {
  std::vector<Vector> result;
  for (const auto& b : balls_) result.push_back(position_now(b));
  return result;
}

}  // namespace edmill::performance
