// A mill in double whose wall search is the thesis's (3.2.2.3): steps of 1e-2 s that are halved
// when the ball is found outside, and contact within 1e-5 m. Written from docs/theory.md; it
// includes nothing of edmill. README.md.
#include <array>
#include <cmath>
#include <iostream>
#include <map>
#include <random>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

struct Vec {
  double x = 0, y = 0, z = 0;
  Vec operator+(const Vec& o) const { return {x + o.x, y + o.y, z + o.z}; }
  Vec operator-(const Vec& o) const { return {x - o.x, y - o.y, z - o.z}; }
  Vec operator*(double s) const { return {x * s, y * s, z * s}; }
};
double dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec cross(const Vec& a, const Vec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

const double pi = std::acos(-1.0);

// SI; the values of the thesis's table 5.4, and what the command line says.
struct Mill {
  double rpm = 1054, arm = 0.1, swing = pi / 12, radius = 0.019, half_height = 0.0285,
         gravity = 9.8;
  double ball_radius = 0, density = 8000, inertia = 0.4, restitution = 0, friction = 0.4;
  double collapse_time =
      1e-4;  // an impact within this time of the last one of either body has e = 1
  double least_separation = 0;   // least speed at which bodies separate [m/s]
  std::string search = "exact";  // or "stepped"
  double step = 1e-2, tolerance = 1e-5, factor = 2, refinements = 12;  // of the stepped search
  double put_back = 0;  // stepped search: 1 to put a ball back on the wall's surface at an impact
  double ignore = 0;    // exact search: walls are ignored for this time after a ball's last impact
  double smooth_time = 0;  // an impact within this time of the last one is elastic and frictionless

  double omega() const { return 2 * pi * rpm / 60; }
  double mass() const { return density * 4 / 3 * pi * ball_radius * ball_radius * ball_radius; }
};

// Theory, section 1: P = R_z(theta) [ (l, 0, 0) + R_x(gamma) p ].
struct Pose {
  double arm, ct, st, cg, sg, theta_rate, gamma_rate;

  Pose(const Mill& m, double time) : arm(m.arm) {
    const double w = m.omega(), c = std::cos(w * time), s = std::sin(w * time);
    const double theta = m.swing * c + pi / 2, gamma = m.swing * s;
    theta_rate = -m.swing * w * s;
    gamma_rate = m.swing * w * c;
    ct = std::cos(theta), st = std::sin(theta), cg = std::cos(gamma), sg = std::sin(gamma);
  }
  Vec outward(const Vec& p) const {
    const double y = cg * p.y - sg * p.z, z = sg * p.y + cg * p.z;
    return {ct * p.x - st * y, st * p.x + ct * y, z};
  }
  Vec inward(const Vec& d) const {
    const double x = ct * d.x + st * d.y, y = ct * d.y - st * d.x;
    return {x, cg * y + sg * d.z, cg * d.z - sg * y};
  }
  Vec centre() const { return {arm * ct, arm * st, 0}; }
  Vec velocity(const Vec& P) const {
    const Vec about_z{0, 0, theta_rate}, about_x{ct * gamma_rate, st * gamma_rate, 0};
    return cross(about_z, P) + cross(about_x, P - centre());
  }
};

struct Flight {
  Vec r, v;
  double start = 0;
  Vec position(const Mill& m, double tau) const {
    return r + v * tau - Vec{0, m.gravity * tau * tau / 2, 0};
  }
  Vec velocity(const Mill& m, double tau) const { return v - Vec{0, m.gravity * tau, 0}; }
};

struct Gap {
  double value, rate;
};
// Section 2: distances to the walls [m] and their rates.
std::array<Gap, 3> gaps(const Mill& m, const Flight& f, double tau) {
  const Pose pose(m, f.start + tau);
  const Vec P = f.position(m, tau), p = pose.inward(P - pose.centre());
  const Vec u = pose.inward(f.velocity(m, tau) - pose.velocity(P));
  const double h = m.half_height - m.ball_radius, off_axis = std::hypot(p.x, p.z);
  const double outwards = off_axis > 0 ? (p.x * u.x + p.z * u.z) / off_axis : 0;
  return {{{h + p.y, u.y}, {h - p.y, -u.y}, {m.radius - m.ball_radius - off_axis, -outwards}}};
}

struct Contact {
  double tau;
  unsigned wall;
};

// Thesis 3.2.2.3 as we read it: figure 3.2 is not reproduced in words.
Contact stepped_search(const Mill& m, const Flight& flight) {
  double tau = 0, step = m.step, refinements = 0;
  for (long steps = 0; steps < 10'000'000; ++steps) {
    const auto g = gaps(m, flight, tau + step);
    unsigned k = 0;
    for (unsigned j = 1; j < 3; ++j)
      if (g[j].value < g[k].value) k = j;
    if (g[k].value > m.tolerance) {
      tau += step;
    } else if (g[k].value < -m.tolerance && refinements < m.refinements) {
      step /= m.factor;
      ++refinements;
    } else {
      return {tau + step, k};
    }
  }
  throw std::runtime_error("a ball meets no wall");
}

// Short steps, grazes examined where a rate changes sign, bisection to the last bit.
Contact exact_search(const Mill& m, const Flight& flight) {
  const auto closes = [](const Gap& g) { return g.value <= 0 && g.rate < 0; };
  double a = m.ignore, step = 1e-9;
  auto old = gaps(m, flight, a);
  for (unsigned k = 0; k < 3; ++k)
    if (closes(old[k])) return {a, k};
  while (a < 10) {
    const double b = a + step;
    const auto now = gaps(m, flight, b);
    Contact first{HUGE_VAL, 3};
    for (unsigned k = 0; k < 3; ++k) {
      double low = a, high = b;
      bool found = closes(now[k]);
      if (!found && old[k].rate < 0 && now[k].rate >= 0 &&
          std::min(old[k].value, now[k].value) < 1e-6) {
        for (int i = 0; i < 60 && !found; ++i) {  // to the least gap
          const double middle = (low + high) / 2;
          const Gap g = gaps(m, flight, middle)[k];
          if (g.rate < 0) low = middle;
          if (!(g.rate < 0)) high = middle;
          if (closes(g)) found = true, high = middle;
        }
        low = a;
      }
      if (!found) continue;
      for (double middle; middle = (low + high) / 2, middle > low && middle < high;)
        (closes(gaps(m, flight, middle)[k]) ? high : low) = middle;
      if (high < first.tau) first = {high, k};
    }
    if (first.wall < 3) return first;
    a = b;
    old = now;
    step = std::min(1.5 * step, 5e-5);
  }
  throw std::runtime_error("a ball meets no wall");
}

struct Totals {
  double dose = 0;
  std::array<long, 4> impacts{};  // caps, cylinder, balls
  long departing = 0;             // contacts of balls that do not approach: no impact
};

class SteppedMill {
 public:
  SteppedMill(const Mill& mill, unsigned count, unsigned long seed) : m_(mill) {
    place(count, seed);
  }

  void run_until(double end) {
    for (unsigned i = earliest(); balls_[i].next.time <= end; i = earliest()) {
      const Next next = balls_[i].next;
      now_ = next.time;
      collide(i, next);
      predict(i);
      if (next.with_ball) predict(next.partner);
    }
  }
  Totals take_totals() {
    const Totals t = totals_;
    totals_ = {};
    return t;
  }
 private:
  struct Next {
    double time;
    bool with_ball;
    unsigned partner;
    unsigned long partner_impacts;
  };
  struct Ball {
    Flight flight;
    Vec spin;
    double last_impact;
    unsigned long impacts = 0;
    Contact wall{};
    Next next{};
  };

  // At rest, at random, no ball near another or a wall.
  void place(unsigned count, unsigned long seed) {
    std::mt19937_64 bits(seed);
    const auto uniform = [&](double limit) {
      return limit * (2 * static_cast<double>(bits() >> 11) / 9007199254740992.0 - 1);
    };
    const Pose pose(m_, 0);
    const double gap = 2e-4, R = m_.ball_radius, r = m_.radius - R - gap,
                 h = m_.half_height - R - gap;
    for (long tries = 0; balls_.size() < count; ++tries) {
      if (tries > 10'000'000) throw std::runtime_error("the balls find no place");
      const Vec p{uniform(r), uniform(h), uniform(r)};
      bool free = std::hypot(p.x, p.z) < r;
      const Vec P = pose.centre() + pose.outward(p);
      for (const Ball& b : balls_)
        free = free && dot(P - b.flight.r, P - b.flight.r) > (2 * R + gap) * (2 * R + gap);
      if (free) balls_.push_back({{P, {}, 0}, {}, -1, 0, {}, {}});
    }
    for (Ball& b : balls_) search_walls(b);
    for (unsigned i = 0; i < count; ++i) predict(i);
  }

  Vec position(const Ball& b) const { return b.flight.position(m_, now_ - b.flight.start); }
  Vec velocity(const Ball& b) const { return b.flight.velocity(m_, now_ - b.flight.start); }

  void search_walls(Ball& b) {
    b.wall = m_.search == "stepped" ? stepped_search(m_, b.flight) : exact_search(m_, b.flight);
  }
  void predict(unsigned i) {
    Ball& b = balls_[i];
    b.next = {b.flight.start + b.wall.tau, false, b.wall.wall, 0};
    const Vec r0 = position(b), v0 = velocity(b);
    for (unsigned j = 0; j < balls_.size(); ++j) {
      if (j == i) continue;
      const Vec r = r0 - position(balls_[j]), v = v0 - velocity(balls_[j]);
      const double rv = dot(r, v), c = dot(r, r) - 4 * m_.ball_radius * m_.ball_radius;
      const double root = rv * rv - dot(v, v) * c;
      if (rv >= 0 || (c > 0 && root < 0)) continue;
      const double time = c <= 0 ? now_ : now_ + c / (std::sqrt(root) - rv);  // (3.1)
      if (time < b.next.time) b.next = {time, true, j, balls_[j].impacts};
    }
  }
  unsigned earliest() {
    while (true) {
      unsigned best = 0;
      for (unsigned i = 1; i < balls_.size(); ++i)
        if (balls_[i].next.time < balls_[best].next.time) best = i;
      const Next& next = balls_[best].next;
      if (!next.with_ball || balls_[next.partner].impacts == next.partner_impacts) return best;
      predict(best);  // the partner has collided since
    }
  }

  bool within(double time, const Ball& a, const Ball* b) const {
    return now_ - a.last_impact < time || (b && now_ - b->last_impact < time);
  }
  void restart(Ball& b, const Vec& r, const Vec& v, const Vec& spin, bool impact) {
    b.flight = {r, v, now_};
    b.spin = spin;
    if (impact) b.last_impact = now_;
    ++b.impacts;
    search_walls(b);
  }
  static Vec wall_normal(const Pose& pose, const Vec& r, unsigned id) {
    if (id < 2) return pose.outward({0, id == 0 ? 1.0 : -1.0, 0});
    const Vec p = pose.inward(r - pose.centre());
    const double distance = std::hypot(p.x, p.z);
    return pose.outward({-p.x / distance, 0, -p.z / distance});
  }

  // Section 5 for balls of one kind: c is 1 + 1/J, M is the mass or half of it.
  void collide(unsigned i, const Next& next) {
    Ball& a = balls_[i];
    Ball* b = next.with_ball ? &balls_[next.partner] : nullptr;
    const double R = m_.ball_radius, J = m_.inertia, c = 1 + 1 / J, share = b ? 0.5 : 1;
    const Vec ra = position(a), va = velocity(a), rb = b ? position(*b) : Vec{};
    const Pose pose(m_, now_);
    const Vec n = b ? (ra - rb) * (1 / std::sqrt(dot(ra - rb, ra - rb)))
                    : wall_normal(pose, ra, next.partner);
    const Vec vb = b ? velocity(*b) : pose.velocity(ra - n * R);
    const Vec g = va - vb - cross((b ? a.spin + b->spin : a.spin) * R, n), gt = g - n * dot(g, n);
    const double approach = -dot(g, n), slip = std::sqrt(dot(gt, gt));
    if (approach <= 0) {
      ++totals_.departing;
      restart(a, ra, va, a.spin, false);
      if (b) restart(*b, rb, vb, b->spin, false);
      return;
    }
    const bool smooth = within(m_.smooth_time, a, b);
    const double e = smooth || within(m_.collapse_time, a, b) ? 1 : m_.restitution;
    const double leave = std::max(e * approach, m_.least_separation), impulse = approach + leave;
    const double et = smooth ? 1
        : slip > 0           ? std::max(-1.0, 1 - m_.friction * impulse * c / slip)
                             : -1;
    const Vec change = (n * impulse - gt * ((1 - et) / c)) * share;
    const Vec turn = cross(n, gt) * (share * (1 - et) / (c * R * J));
    const double depth =
        b || m_.put_back == 0 ? 0 : gaps(m_, {ra, va, now_}, 0)[next.partner].value;
    restart(a, ra - n * depth, va + change, a.spin + turn, true);
    if (b) restart(*b, rb, vb - change, b->spin + turn, true);
    const double normal = std::max(0.0, approach * approach - leave * leave);
    totals_.dose += share * m_.mass() / 2 * (normal + (1 - et * et) / c * slip * slip);
    ++totals_.impacts[b ? 3 : next.partner];
  }

  Mill m_;
  double now_ = 0;
  std::vector<Ball> balls_;
  Totals totals_;
};

}  // namespace

int main(int argc, char** argv) try {
  Mill mill;
  double count = 0, diameter_mm = 0, seed = 1, start = 1, end = 11, batch = 1;
  const std::map<std::string, double*> numbers = {{"--balls", &count},
      {"--diameter-mm", &diameter_mm}, {"--restitution", &mill.restitution}, {"--seed", &seed},
      {"--start", &start}, {"--end", &end}, {"--batch", &batch},
      {"--collapse-time", &mill.collapse_time}, {"--least-separation", &mill.least_separation},
      {"--ignore", &mill.ignore}, {"--step", &mill.step}, {"--tolerance", &mill.tolerance},
      {"--factor", &mill.factor}, {"--refinements", &mill.refinements},
      {"--put-back", &mill.put_back}, {"--smooth-time", &mill.smooth_time}};
  for (int k = 1; k < argc; k += 2) {
    const std::string key = argv[k];
    if (k + 1 == argc || (key != "--search" && !numbers.count(key)))
      throw std::runtime_error("what is " + key);
    if (key == "--search")
      mill.search = argv[k + 1];
    else
      *numbers.at(key) = std::stod(argv[k + 1]);
  }
  if (count < 1 || diameter_mm <= 0 || mill.restitution <= 0 ||
      (mill.search != "exact" && mill.search != "stepped"))
    throw std::runtime_error(
        "needed: --balls N --diameter-mm D --restitution E, and --search exact or stepped");
  mill.ball_radius = diameter_mm / 2000;
  SteppedMill simulation(mill, static_cast<unsigned>(count), static_cast<unsigned long>(seed));
  simulation.run_until(start);
  simulation.take_totals();
  std::cout << "milling_dose,wall_0,wall_1,wall_2,ball_ball,departing\n";
  std::cout.precision(10);
  for (double time = start + batch; time < end + batch / 2; time += batch) {
    simulation.run_until(time);
    const Totals t = simulation.take_totals();
    std::cout << t.dose;
    for (const long impacts : t.impacts) std::cout << ',' << impacts;
    std::cout << ',' << t.departing << std::endl;
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "stepped_mill: " << error.what() << '\n';
  return 2;
}
