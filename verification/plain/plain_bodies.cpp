// A plain mill with bodies inside the vessel, from docs/theory.md alone: no code, data structure or
// search of edmill. Vessel and bodies move on chains of joints; a wall is found by its distance
// from the ball and a bound on the speed at which this can change.
#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <cmath>
#include <fstream>
#include <iostream>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "states.hpp"

namespace {

template <class S> S length(const Vec<S>& v) {
  using std::sqrt;
  return sqrt(dot(v, v));
}
template <class To, class From> Vec<To> cast(const Vec<From>& v) {
  return {static_cast<To>(v.x), static_cast<To>(v.y), static_cast<To>(v.z)};
}

template <class S> struct Swing {
  S amplitude, rate, phase;  // [rad] or [m], [rad/s], [rad]
};
template <class S> struct Joint {
  bool turns;
  Vec<S> axis, shift;  // a unit vector; constant
  S angle{}, speed{};  // constant part [rad] or [m], [rad/s] or [m/s]
  std::vector<Swing<S>> swings;
};

// The axes of a frame as columns, its origin, and how both move.
template <class S> struct Pose {
  std::array<Vec<S>, 3> axes{
      Vec<S>{S(1), S(0), S(0)}, Vec<S>{S(0), S(1), S(0)}, Vec<S>{S(0), S(0), S(1)}};
  Vec<S> origin, origin_speed, turning;

  Vec<S> outward(const Vec<S>& p) const { return axes[0] * p.x + axes[1] * p.y + axes[2] * p.z; }
  Vec<S> inward(const Vec<S>& d) const {
    return {dot(axes[0], d), dot(axes[1], d), dot(axes[2], d)};
  }
  // Velocity of the frame's point that is at P.
  Vec<S> velocity(const Vec<S>& P) const { return origin_speed + cross(turning, P - origin); }
};

template <class S> struct Frame {
  std::vector<Joint<S>> joints;

  Pose<S> pose(const S& time) const {
    using std::cos, std::sin;
    Pose<S> pose;
    for (const Joint<S>& j : joints) {
      S value = j.angle + j.speed * time, rate = j.speed;
      for (const Swing<S>& s : j.swings) {
        value += s.amplitude * sin(s.rate * time + s.phase);
        rate += s.amplitude * s.rate * cos(s.rate * time + s.phase);
      }
      const Vec<S> axis = pose.outward(j.axis);
      if (!j.turns) {
        const Vec<S> moved = pose.outward(j.shift) + axis * value;
        pose.origin_speed = pose.origin_speed + axis * rate + cross(pose.turning, moved);
        pose.origin = pose.origin + moved;
        continue;
      }
      const S c = cos(value), s = sin(value);
      for (Vec<S>& a : pose.axes)  // Rodrigues' formula
        a = a * c + cross(axis, a) * s + axis * (dot(axis, a) * (1 - c));
      pose.turning = pose.turning + axis * rate;
    }
    return pose;
  }
};

template <class S> struct Wall {
  std::string kind;
  Vec<S> size;  // of a plane its outward normal; half edges or radius, half height of a solid
  S more{};     // of a plane its distance, of a cylinder its radius, of a solid its rounding
  unsigned frame = 0;

  // From the nearest point of the wall, or of a solid's core, to a ball's centre at p; its length
  // is signed.
  std::pair<Vec<S>, S> apart(const Vec<S>& p) const {
    using std::sqrt;
    if (kind == "plane") return {size * S(-1), more - dot(size, p)};
    const S r = sqrt(p.x * p.x + p.z * p.z);
    if (kind == "cylinder") return {Vec<S>{-p.x / r, S(0), -p.z / r}, more - r};
    auto beyond = [](const S& x, const S& half) {
      return x > half ? S(x - half) : x < -half ? S(x + half) : S(0);
    };
    Vec<S> u{beyond(p.x, size.x), beyond(p.y, size.y), beyond(p.z, size.z)};
    if (kind == "round") {
      const S share = r > size.x ? S((r - size.x) / r) : S(0);
      u = {p.x * share, u.y, p.z * share};
    }
    const S distance = length(u);
    return {distance > 0 ? u * (1 / distance) : Vec<S>{S(0), S(1), S(0)}, distance - more};
  }
};

template <class S> struct Flight {
  Vec<S> r, v;
  S start{};
};

// Vessel, bodies and law, in a scalar; the balls are alike.
template <class S> struct Mill {
  std::vector<Frame<S>> frames;
  std::vector<Wall<S>> walls;
  S gravity{}, radius{}, density{}, inertia{}, restitution{}, friction{}, least_separation{},
      fastest{};

  Vec<S> place(const Flight<S>& f, const S& time) const {
    const S dt = time - f.start;
    return f.r + f.v * dt - Vec<S>{S(0), gravity * dt * dt / 2, S(0)};
  }
  Vec<S> velocity(const Flight<S>& f, const S& time) const {
    return f.v - Vec<S>{S(0), gravity * (time - f.start), S(0)};
  }
  struct Gap {
    S value, rate;
  };
  Gap gap(const Flight<S>& f, unsigned wall, const S& time, const Pose<S>& pose) const {
    const Vec<S> P = place(f, time), u = pose.inward(velocity(f, time) - pose.velocity(P));
    const auto [normal, distance] = walls[wall].apart(pose.inward(P - pose.origin));
    return {distance - radius, dot(normal, u)};
  }
  Gap gap(const Flight<S>& f, unsigned wall, const S& time) const {
    return gap(f, wall, time, frames[walls[wall].frame].pose(time));
  }
};

// What a file describes, one word and numbers a line: lengths in m, angles in degrees, speeds of
// rotation in rpm.
template <class T> Mill<T> read_mill(std::istream& in) {
  const T pi = boost::math::constants::pi<T>(), degree = pi / 180, rpm = pi / 30;
  Mill<T> mill;
  std::string line, word, text;
  while (std::getline(in, line)) {
    std::istringstream words(line);
    words >> word;
    const auto number = [&] {
      if (!(words >> text)) throw std::runtime_error("short line: " + line);
      return T(text);
    };
    const auto vector = [&] {
      const T x = number(), y = number(), z = number();
      return Vec<T>{x, y, z};
    };
    if (word == "frame") {
      mill.frames.emplace_back();
    } else if (word == "rotate") {
      const Vec<T> axis = vector();
      const T angle = number() * degree, speed = number() * rpm;
      mill.frames.back().joints.push_back({true, axis * (1 / length(axis)), {}, angle, speed, {}});
    } else if (word == "translate") {
      const Vec<T> shift = vector(), axis = vector();
      const T speed = number();
      mill.frames.back().joints.push_back(
          {false, axis * (1 / length(axis)), shift, T(0), speed, {}});
    } else if (word == "swing") {
      Joint<T>& joint = mill.frames.back().joints.back();
      const T amplitude = number() * (joint.turns ? degree : T(1)), rate = number() * rpm,
              phase = number() * degree;
      joint.swings.push_back({amplitude, rate, phase});
    } else if (word == "plane" || word == "cylinder" || word == "box" || word == "round") {
      Wall<T> wall{word, {}, {}, static_cast<unsigned>(mill.frames.size() - 1)};
      if (word != "cylinder") wall.size = vector();
      wall.more = number();
      mill.walls.push_back(wall);
    } else {
      const std::pair<const char*, T*> values[] = {{"gravity", &mill.gravity},
          {"radius", &mill.radius}, {"density", &mill.density}, {"inertia", &mill.inertia},
          {"restitution", &mill.restitution}, {"friction", &mill.friction},
          {"fastest", &mill.fastest}, {"least_separation", &mill.least_separation}};
      const auto* value = std::find_if(
          std::begin(values), std::end(values), [&](const auto& v) { return v.first == word; });
      if (value == std::end(values)) throw std::runtime_error("what is " + word);
      *value->second = number();
    }
  }
  return mill;
}

template <class T> Mill<double> in_double(const Mill<T>& m) {
  const auto d = [](const T& x) { return static_cast<double>(x); };
  Mill<double> near;
  for (const Frame<T>& frame : m.frames) {
    Frame<double>& own = near.frames.emplace_back();
    for (const Joint<T>& j : frame.joints) {
      own.joints.push_back(
          {j.turns, cast<double>(j.axis), cast<double>(j.shift), d(j.angle), d(j.speed), {}});
      for (const Swing<T>& s : j.swings)
        own.joints.back().swings.push_back({d(s.amplitude), d(s.rate), d(s.phase)});
    }
  }
  for (const Wall<T>& w : m.walls)
    near.walls.push_back({w.kind, cast<double>(w.size), d(w.more), w.frame});
  near.gravity = d(m.gravity), near.radius = d(m.radius), near.fastest = d(m.fastest);
  return near;
}

template <class T> class PlainBodies {
 public:
  PlainBodies(std::istream& mill, std::istream& states)
      : mill_(read_mill<T>(mill)), near_(in_double(mill_)) {
    const T R = mill_.radius;
    mass_ = mill_.density * 4 / 3 * boost::math::constants::pi<T>() * R * R * R;
    for (const State<T>& s : read_states<T>(states)) {
      now_ = s.time;
      balls_.push_back({{s.position, s.velocity, now_}, s.spin});
    }
    for (Ball& b : balls_) b.wall = first_wall(b);
  }

  void run(unsigned long events, std::ostream& out) {
    out << "index,time,ball,partner_kind,partner,approach_speed,slip_speed,milling_dose,wall_work\n"
        << std::scientific;
    out.precision(std::numeric_limits<T>::max_digits10);
    for (unsigned long index = 0; index < events; ++index) {
      T time = balls_[0].wall.first;
      unsigned ball = 0, partner = balls_[0].wall.second;
      bool pair = false;
      for (unsigned i = 0; i < balls_.size(); ++i) {
        if (balls_[i].wall.first < time)
          time = balls_[i].wall.first, ball = i, partner = balls_[i].wall.second, pair = false;
        for (unsigned j = i + 1; j < balls_.size(); ++j) {
          const T meeting = meeting_of(balls_[i], balls_[j]);
          if (meeting < time) time = meeting, ball = i, partner = j, pair = true;
        }
      }
      now_ = time;
      const auto values = collide(ball, pair, partner);
      out << index << ',' << now_ << ',' << ball << (pair ? ",ball," : ",wall,") << partner;
      for (const T& value : values) out << ',' << value;
      out << '\n';
    }
  }
 private:
  struct Ball {
    Flight<T> flight;
    Vec<T> spin;
    int unmoved = 0;  // impacts in a row without time to move
    std::pair<T, unsigned> wall{};
  };

  // (3.1), for balls that fall alike.
  T meeting_of(const Ball& a, const Ball& b) const {
    using std::sqrt;
    const T never = std::numeric_limits<T>::max();
    const Vec<T> r = mill_.place(a.flight, now_) - mill_.place(b.flight, now_);
    const Vec<T> v = mill_.velocity(a.flight, now_) - mill_.velocity(b.flight, now_);
    const T rv = dot(r, v), vv = dot(v, v), c = dot(r, r) - 4 * mill_.radius * mill_.radius;
    const T root = rv * rv - vv * c;
    if (!(rv < 0) || !(root > 0)) return never;
    return c <= 0 ? now_ : T(now_ + c / (sqrt(root) - rv));
  }

  std::pair<T, unsigned> first_wall(const Ball& ball) const {
    std::pair<T, unsigned> first{std::numeric_limits<T>::max(), 0};
    for (unsigned wall = 0; wall < mill_.walls.size(); ++wall) {
      const T time = contact(ball.flight, wall, std::min(first.first, T(ball.flight.start + 2)));
      if (time < first.first) first = {time, wall};
    }
    return first;
  }

  // The first contact with a wall before `end`. No gap can fall faster than the ball and the
  // fastest wall move: the time that this takes is passed at once, in double where that decides.
  // Close to a wall a bound on the acceleration of the gap passes more, and shows that a gap that
  // falls has one root. Steps are at least 1e-14 s.
  T contact(const Flight<T>& flight, unsigned wall, const T& end) const {
    const Flight<double> near{
        cast<double>(flight.r), cast<double>(flight.v), static_cast<double>(flight.start)};
    const double fastest = near_.fastest + length(near.v) + 2 * near_.gravity;
    const double bend = 4 * fastest * fastest / near_.radius + 1000;
    T time = flight.start, step(0);
    while (time < end) {
      double value = near_.gap(near, wall, static_cast<double>(time)).value, at_least = 1e-14;
      if (value < 1e-10) {
        const auto gap = mill_.gap(flight, wall, time);
        const double rate = static_cast<double>(gap.rate);
        value = static_cast<double>(gap.value);
        if (gap.value <= 0 && gap.rate < 0)
          return time == flight.start ? time : root(flight, wall, T(time - step), time);
        const double late = std::sqrt(rate * rate + 2 * bend * std::max(value, 0.0));
        at_least += rate > 0 ? (rate + late) / bend : 2 * std::max(value, 0.0) / (late - rate);
        if (rate < 0 && rate * rate > 4 * bend * value) {
          const T after = time + T(2 * value / -rate);
          if (mill_.gap(flight, wall, after).value < 0) return root(flight, wall, time, after);
        }
      }
      step = T(std::max(value / fastest, at_least));
      time += step;
    }
    return std::numeric_limits<T>::max();
  }

  // Where the gap falls to zero, between a time where it is positive or grows and one where it is
  // not.
  T root(const Flight<T>& flight, unsigned wall, T a, T b) const {
    const T least = 8 * std::numeric_limits<T>::epsilon() * b;
    T x = (a + b) / 2;
    while (b - a > least) {
      const auto gap = mill_.gap(flight, wall, x);
      (gap.value > 0 || gap.rate > 0 ? a : b) = x;
      const T next = x - gap.value / gap.rate;
      if (abs(next - x) <= least && gap.rate < 0) return next;
      x = next > a && next < b && gap.rate < 0 ? next : T((a + b) / 2);
    }
    return x;
  }

  // Sections 5 and 6.
  std::array<T, 4> collide(unsigned i, bool pair, unsigned partner) {
    Ball& a = balls_[i];
    Ball* b = pair ? &balls_[partner] : nullptr;
    const T R = mill_.radius, J = mill_.inertia, c = 1 + 1 / J, share = b ? T(0.5) : T(1);
    const Vec<T> ra = mill_.place(a.flight, now_), va = mill_.velocity(a.flight, now_);
    Vec<T> n, other;
    if (b) {
      const Vec<T> apart = ra - mill_.place(b->flight, now_);
      n = apart * (1 / length(apart));
      other = mill_.velocity(b->flight, now_);
    } else {
      const Wall<T>& wall = mill_.walls[partner];
      const Pose<T> pose = mill_.frames[wall.frame].pose(now_);
      n = pose.outward(wall.apart(pose.inward(ra - pose.origin)).first);
      other = pose.velocity(ra - n * R);
    }
    const Vec<T> spins = b ? a.spin + b->spin : a.spin;
    const Vec<T> g = va - other - cross(spins * R, n), gt = g - n * dot(g, n);
    const T approach = -dot(g, n), slip = length(gt);
    const T leave = std::max(
        approach > 0 ? T(mill_.restitution * approach) : T(-approach), mill_.least_separation);
    const T jump = approach + leave;
    T et = -1;
    if (slip > 0) et = std::max(et, T(1 - mill_.friction * c * jump / slip));
    bool stalled = false;
    for (Ball* ball : {&a, b}) {
      if (!ball) continue;
      ball->unmoved =
          (now_ - ball->flight.start) * 30000 < mill_.least_separation ? ball->unmoved + 1 : 0;
      stalled = stalled || ball->unmoved > 32;
    }
    if (stalled) et = 1;
    const Vec<T> along = gt * ((1 - et) / c);
    const Vec<T> change = (n * jump - along) * share, turn = cross(n, along) * (share / (R * J));
    a.flight = {ra, va + change, now_};
    a.spin = a.spin + turn;
    if (b) {
      b->flight = {mill_.place(b->flight, now_), other - change, now_};
      b->spin = b->spin + turn;
      b->wall = first_wall(*b);
    }
    a.wall = first_wall(a);
    const T dose = share * mass_ / 2 *
        (std::max(T(0), T(approach * approach - leave * leave)) + (1 - et * et) / c * slip * slip);
    return {approach, slip, dose, b ? T(0) : T(mass_ * dot(other, change))};
  }

  Mill<T> mill_;
  Mill<double> near_;
  T mass_, now_{};
  std::vector<Ball> balls_;
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 4) throw std::runtime_error("usage: plain_bodies MILL STATES.csv EVENTS");
  std::ifstream mill(argv[1]), states(argv[2]);
  if (!mill || !states) throw std::runtime_error("cannot read the mill or the states");
  PlainBodies<Mpfr100>(mill, states).run(std::stoul(argv[3]), std::cout);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "plain_bodies: " << error.what() << '\n';
  return 2;
}
