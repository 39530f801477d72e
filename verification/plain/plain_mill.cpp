// A second ball mill, from docs/theory.md alone: no code, data structure or search of edmill. Slow
// and plain.
#include <algorithm>
#include <array>
#include <boost/math/constants/constants.hpp>
#include <fstream>
#include <iostream>
#include <limits>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "faults.hpp"
#include "flights.hpp"
#include "states.hpp"

namespace {

template <class T> class PlainMill {
 public:
  PlainMill(std::istream& states, const Options& o)
      : fault_(o), with_states_(o.at("states") == "1") {
    auto number = [&](const char* name) { return T(o.at(name)); };
    const T degree = boost::math::constants::pi<T>() / 180;
    mill_.turns_per_second = number("rpm") / 60, mill_.arm = number("arm"),
    mill_.gravity = number("gravity");
    mill_.theta_max = number("theta-max") * degree, mill_.gamma_max = number("gamma-max") * degree;
    mill_.radius = number("diameter") / 2, mill_.half_height = number("height") / 2;
    const T R = mill_.ball_radius = number("ball-diameter") / 2;
    mass_ = number("density") * 4 / 3 * boost::math::constants::pi<T>() * R * R * R;
    inertia_ = number("reduced-inertia"), least_separation_ = number("least-separation");
    restitution_ = number("restitution"), friction_ = number("friction");
    min_tangential_ = number("min-tangential");
    for (unsigned wall = 0; wall < 3; ++wall) {
      fault_.meets({"wall", "wall" + std::to_string(wall)});
      mill_.wall_gap[wall] = fault_.of("contact_gap", T(0));
    }
    fault_.meets({"ball"});
    mill_.pair_gap = fault_.of("contact_gap", T(0)),
    mill_.gamma_phase = fault_.of("gamma_phase", T(0));
    for (const State<T>& s : read_states<T>(states)) {
      now_ = s.time;
      const Flight<T> flight{s.position, s.velocity, now_ * mill_.turns_per_second};
      balls_.push_back({flight, s.spin, now_});
      weigh(static_cast<unsigned>(balls_.size() - 1));
    }
    for (Ball& b : balls_) predict_walls(b);
    for (unsigned i = 0; i < balls_.size(); ++i) predict(i);
  }

  void run(unsigned long events, std::ostream& out) {
    out << "index,time,ball,partner_kind,partner,approach_speed,slip_speed,milling_dose,wall_work";
    if (with_states_)
      for (const char* body : {"", "partner_"}) {
        for (const char* axis : {"x", "y", "z"}) out << ',' << body << axis;
        for (const char* when : {"before", "after"})
          for (const char* name : {"vx", "vy", "vz", "wx", "wy", "wz"})
            out << ',' << body << name << '_' << when;
      }
    out << '\n';
    out.precision(std::numeric_limits<T>::max_digits10);
    for (unsigned long index = 0; index < events; ++index) {
      const unsigned i = earliest();
      const Next next = balls_[i].next;
      now_ = next.time;
      // A pair is named by its lower ball.
      const bool pair = next.kind == ball;
      const unsigned a = pair ? std::min(i, next.partner) : i,
                     b = pair ? std::max(i, next.partner) : next.partner;
      out << index << ',' << std::scientific << now_ << ',' << a << (pair ? ",ball," : ",wall,")
          << b;
      const unsigned bodies[] = {a, b};
      std::vector<Vec<T>> states;
      const auto note = [&](unsigned k, bool place) {
        const Ball& own = balls_[bodies[k]];
        if (place) states.push_back(position(own));
        states.push_back(velocity(own)), states.push_back(own.spin);
      };
      for (unsigned k = 0; k < (pair ? 2u : 1u); ++k) note(k, true);
      for (const T& value : collide(a, next.kind, b)) out << ',' << value;
      for (unsigned k = 0; k < (pair ? 2u : 1u); ++k) note(k, false);
      if (with_states_) write(out, states, pair);
      out << '\n';
      predict(a);
      if (pair) predict(b);
    }
  }
 private:
  enum Kind { wall, ball };
  struct Next {
    T time;
    Kind kind;
    unsigned partner;
    unsigned long partner_impacts;
  };
  struct Ball {
    Flight<T> flight;
    Vec<T> spin;
    T start;  // of the flight
    unsigned long impacts = 0;
    T wall_time{};
    unsigned wall_id = 0;
    Next next{};
  };

  // Of each body: place, velocity and spin before, both after.
  static void write(std::ostream& out, const std::vector<Vec<T>>& states, bool pair) {
    for (unsigned k = 0; k < 2; ++k) {
      if (k > 0 && !pair) {
        out << std::string(15, ',');
        continue;
      }
      const std::size_t before = 3 * k, after = (pair ? 6 : 3) + 2 * k;
      for (const std::size_t at : {before, before + 1, before + 2, after, after + 1})
        out << ',' << states[at].x << ',' << states[at].y << ',' << states[at].z;
    }
  }
  // Gravity as the code has it for a ball.
  void weigh(unsigned i) {
    const std::string own = "ball" + std::to_string(i);
    fault_.meets({own});
    const T both = fault_.of("gravity");
    balls_[i].flight.in_place = both * fault_.of("gravity_in_places");
    balls_[i].flight.in_speed = both * fault_.of("gravity_in_velocities");
  }

  Vec<T> position(const Ball& b) const { return b.flight.position(mill_, now_ - b.start); }
  Vec<T> velocity(const Ball& b) const { return b.flight.velocity(mill_, now_ - b.start); }
  Vec<T> rate(const Ball& b) const { return b.flight.rate(mill_, now_ - b.start); }

  void predict_walls(Ball& b) {
    const auto [tau, id] = first_wall(mill_, b.flight);
    b.wall_time = b.start + tau;
    b.wall_id = id;
  }
  void predict(unsigned i) {
    Ball& b = balls_[i];
    b.next = {b.wall_time, wall, b.wall_id, 0};
    const T reach = 2 * mill_.ball_radius + mill_.pair_gap, contact = reach * reach;
    for (unsigned j = 0; j < balls_.size(); ++j) {
      if (j == i) continue;
      if (b.flight.in_place != balls_[j].flight.in_place) {
        if (const auto time = touch(b, balls_[j]); time && *time < b.next.time)
          b.next = {*time, ball, j, balls_[j].impacts};
        continue;
      }
      const Vec<T> r = position(b) - position(balls_[j]), v = rate(b) - rate(balls_[j]);
      const T rv = dot(r, v), c = dot(r, r) - contact, root = rv * rv - dot(v, v) * c;
      if (rv >= 0 || (c > 0 && root < 0)) continue;
      const T time = c <= 0 ? now_ : now_ + c / (sqrt(root) - rv);  // (3.1)
      if (time < b.next.time) b.next = {time, ball, j, balls_[j].impacts};
    }
  }
  // The contact of two balls that fall differently, before one of them meets a wall: samples and
  // bisection.
  std::optional<T> touch(const Ball& a, const Ball& b) const {
    const auto gap = [&](const T& time) {
      const Vec<T> apart =
          a.flight.position(mill_, time - a.start) - b.flight.position(mill_, time - b.start);
      const T reach = 2 * mill_.ball_radius + mill_.pair_gap;
      return T(dot(apart, apart) - reach * reach);
    };
    const T end = std::min(a.wall_time, b.wall_time), step = T(2e-5);
    T last = gap(now_);
    for (T time = now_; time < end; time += step) {
      const T next = gap(time + step);
      if (last > 0 && next <= 0) {
        T low = time, high = time + step;
        for (int k = 0; k < 110; ++k) {
          const T middle = (low + high) / 2;
          (gap(middle) > 0 ? low : high) = middle;
        }
        return high;
      }
      last = next;
    }
    return {};
  }
  // A prediction is void when the partner has collided since.
  unsigned earliest() {
    while (true) {
      unsigned best = 0;
      for (unsigned i = 1; i < balls_.size(); ++i)
        if (balls_[i].next.time < balls_[best].next.time) best = i;
      const Next& next = balls_[best].next;
      if (next.kind == wall || balls_[next.partner].impacts == next.partner_impacts) return best;
      predict(best);
    }
  }

  void restart(unsigned i, const Vec<T>& r, const Vec<T>& v, const Vec<T>& spin) {
    Ball& b = balls_[i];
    b.flight = {r, v, now_ * mill_.turns_per_second};
    weigh(i);
    b.spin = spin;
    b.start = now_;
    ++b.impacts;
    predict_walls(b);
  }
  static Vec<T> wall_normal(const Pose<T>& pose, const Vec<T>& r, unsigned id) {
    if (id < 2) return pose.outward({T(0), T(id == 0 ? 1 : -1), T(0)});
    const Vec<T> p = pose.inward(r - pose.centre());
    const T distance = sqrt(p.x * p.x + p.z * p.z);
    return pose.outward({-p.x / distance, T(0), -p.z / distance});
  }

  // Section 5 for balls of one kind, where c is 1 + 1/J with a wall as with a ball, and M is m or
  // m/2.
  std::array<T, 4> collide(unsigned i, Kind kind, unsigned partner) {
    Ball& a = balls_[i];
    Ball* b = kind == ball ? &balls_[partner] : nullptr;
    const T R = mill_.ball_radius, J = inertia_, c = 1 + 1 / J, share = b ? T(0.5) : T(1);
    const Vec<T> ra = position(a), va = velocity(a), rb = b ? position(*b) : Vec<T>{};
    const Pose<T> pose(mill_, now_ * mill_.turns_per_second);
    const Vec<T> n =
        b ? (ra - rb) * (1 / sqrt(dot(ra - rb, ra - rb))) : wall_normal(pose, ra, partner);
    fault_.meets({b ? "ball" : "wall", (b ? "ball" : "wall") + std::to_string(partner),
        "ball" + std::to_string(i)});
    const Pose<T> late(mill_, (now_ - fault_.of("wall_delay", T(0))) * mill_.turns_per_second);
    const Vec<T> partner_velocity =
        b ? velocity(*b) : late.velocity(ra - n * R) * fault_.of("wall_velocity");
    const Vec<T> spins = (b ? a.spin + b->spin : a.spin) * fault_.of("arm");
    const Vec<T> g = va - partner_velocity - cross(spins * R, n), gt = g - n * dot(g, n);
    const T approach = -dot(g, n), slip = sqrt(dot(gt, gt));
    // Section 6. Bodies that already separate, by rounding, are not slowed down.
    const T slow = fault_.of("least_separation", least_separation_),
            e = fault_.of("restitution", restitution_);
    const T leave = std::max(approach > 0 ? T(e * approach) : T(-approach), slow);
    if (leave == slow) fault_.also("slow");
    const T jump = approach + leave;  // the normal impulse over share * mass
    const T mu = fault_.of("friction", friction_),
            least_et = fault_.of("min_tangential", min_tangential_);
    T et = least_et;
    const T c_limit = 1 + (c - 1) * fault_.of("c_in_limit"),
            c_impulse = 1 + (c - 1) * fault_.of("c_in_impulse");
    const T constant = fault_.of("constant_e_t", T(2));
    if (slip > 0) et = std::max(et, T(1 - mu * c_limit * jump / slip));
    if (constant <= 1) et = constant;
    fault_.also(et > least_et ? "slide" : "stick");
    const T impulse = fault_.of("friction_impulse"), mass_share = share * fault_.of("share");
    const Vec<T> along = gt * ((1 - et) / c_impulse * impulse);
    const Vec<T> change = (n * jump - along * fault_.of("friction_on_velocity")) * mass_share;
    const Vec<T> turn = cross(n, along) * (mass_share / (R * J) * fault_.of("torque"));
    const T torque_of_a = fault_.of("torque_of_ball", T(1)),
            torque_of_b = fault_.of("torque_of_partner", T(1));
    const Vec<T> old_spin = a.spin, old_spin_b = b ? b->spin : Vec<T>{};
    restart(i, ra, va + change, a.spin + turn * (b ? torque_of_a : T(1)));
    if (b) restart(partner, rb, partner_velocity - change, b->spin + turn * torque_of_b);
    fault_.meets({b ? "ball" : "wall", (b ? "ball" : "wall") + std::to_string(partner),
        "ball" + std::to_string(i)});
    const T work = b ? T(0) : T(mass_ * dot(partner_velocity, change));
    const auto spin_energy = [&](const Vec<T>& before, const Vec<T>& after) {
      return T(mass_ * J * R * R / 2 * (dot(after, after) - dot(before, before)));
    };
    const T of_spin = spin_energy(old_spin, a.spin) + (b ? spin_energy(old_spin_b, b->spin) : T(0));
    const T normal_loss =
        std::max(T(0), T(approach * approach - leave * leave));  // below 0: supplied
    const T supplied = std::max(T(0), T(share * mass_ / 2 * (leave * leave - approach * approach)));
    const T dose = share * mass_ / 2 * (normal_loss + (1 - et * et) / c * slip * slip) +
        work * (fault_.of("work_in_dose") - 1) - of_spin * (fault_.of("spin_in_dose") - 1) +
        supplied * (fault_.of("supply_in_dose") - 1);
    return {approach * fault_.of("approach_speed"), slip * fault_.of("slip_speed"),
        dose * fault_.of("dose"), work * fault_.of("wall_work")};
  }

  Faults<T> fault_;
  bool with_states_;
  Mill<T> mill_;
  T mass_, inertia_, restitution_, friction_, min_tangential_, least_separation_, now_{};
  std::vector<Ball> balls_;
};

}  // namespace

int main(int argc, char** argv) try {
  // SI, angles in degrees.
  std::istringstream defaults(
      "scalar mpfr100 rpm 1098 arm 0.1 theta-max 15 gamma-max 15 diameter 0.038 height 0.057 "
      "gravity 9.8 "
      "ball-diameter 0.00476 density 8000 reduced-inertia 0.4 restitution 0.5 friction 0.4 "
      "min-tangential -1 "
      "least-separation 0.01 fault none fault-value 1 where all states 0");
  Options options;
  for (std::string key, value; defaults >> key >> value;) options[key] = value;
  if (argc < 3 || argc % 2 == 0)
    throw std::runtime_error("usage: plain_mill STATES.csv EVENTS [--option value]...");
  for (int k = 3; k < argc; k += 2) {
    const std::string name = argv[k];
    if (name.substr(0, 2) != "--" || !options.count(name.substr(2)))
      throw std::runtime_error("what is " + name);
    options[name.substr(2)] = argv[k + 1];
  }
  std::ifstream states(argv[1]);
  if (!states) throw std::runtime_error(std::string("cannot read ") + argv[1]);
  const unsigned long events = std::stoul(argv[2]);
  if (options["scalar"] == "mpfr100")
    PlainMill<Mpfr100>(states, options).run(events, std::cout);
  else if (options["scalar"] == "float128")
    PlainMill<float128>(states, options).run(events, std::cout);
  else
    throw std::runtime_error("no scalar " + options["scalar"]);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "plain_mill: " << error.what() << '\n';
  return 2;
}
