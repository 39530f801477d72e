// A DEM code of springs and dashpots, linear ones or Hertz's, in a vibrated box, with mistakes by
// name: frames to standard output, as LAMMPS writes them. Shares no code with edmill.
//
// usage: spring_dem [NAME=VALUE...]   a name that it does not have is an error
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <random>
#include <string>
#include <vector>

namespace {

using V = std::array<double, 3>;
V operator+(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V operator-(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
V operator*(const V& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
const double pi = std::acos(-1.0);

/// What a run has, and its mistakes; factors are 1, axes and walls -1 where there is none.
std::map<std::string, double> options{// the run: number of balls, duration of a contact [s], time
                                      // steps in it, steps between frames, digits
    {"balls", 5}, {"small_balls", 0}, {"hertz", 0}, {"contact_time", 1e-4}, {"steps", 50},
    {"every", 10}, {"digits", 9}, {"duration", 0.6}, {"seed", 1}, {"restitution", 0.6},
    {"friction", 0.4}, {"with_sizes", 1}, {"first_ball", 1},
    // contacts
    {"restitution_of_walls", -1}, {"restitution_of_pairs", -1}, {"friction_of_walls", -1},
    {"friction_of_pairs", -1}, {"restitution_by_speed", 0}, {"mixed_restitution", 0},
    {"other_wall", -1}, {"restitution_of_other_wall", 0.4}, {"other_ball", -1},
    {"restitution_of_other_ball", 0.4}, {"mass_of_pairs", 1}, {"torque", 1}, {"inertia", 1},
    {"missing_wall", -1}, {"no_pairs", 0}, {"missing_share", 0}, {"attraction", 0},
    {"wall_velocity", 1}, {"tangential_damping", 0}, {"no_spin_in_slip", 0},
    // mill, vessel and balls
    {"gravity", 1}, {"gravity_axis", 1}, {"radius", 1}, {"radius_of_last", 1},
    {"density_of_last", 1}, {"density", 1}, {"size_x", 1}, {"size_y", 1}, {"size_z", 1},
    {"amplitude", 1}, {"amplitude_y", 1}, {"speed", 1}, {"phase", 0}, {"phase_y", 0},
    {"periodic_axis", -1}, {"shift_x", 0},
    // the dump
    {"length_unit", 1}, {"spin_sign", 1}, {"spin_unit", 1}, {"exchanged_axes", 0},
    {"turned_axes", 0}, {"scaled", 0}};
double at(const char* name) { return options.at(name); }
int whole(const char* name) { return static_cast<int>(at(name)); }

/// Duration of an undamped contact in units of its mass and stiffness, for Hertz at a speed of one.
double unit_of_time() { return at("hertz") != 0 ? 2.9432750 : pi; }

/// Force along the normal in these units.
double normal_force(double overlap, double speed, double damping) {
  if (at("hertz") != 0)
    return overlap * std::sqrt(overlap) + damping * std::sqrt(std::sqrt(overlap)) * speed;
  return overlap + damping * speed;
}

/// Of a contact with this damping.
double restitution_of(double damping, int steps) {
  const double step = unit_of_time() / steps;
  double x = step / 2, v = 1;
  while (true) {
    const double force = std::max(0.0, normal_force(x, v, damping));
    v -= force * step;
    x += v * step;
    if (x <= 0 || (v < 0 && force == 0)) return -v;
  }
}
double damping_for(double restitution, int steps) {
  double low = 0, high = 4;
  for (int k = 0; k < 50; ++k) {
    const double middle = (low + high) / 2;
    (restitution_of(middle, steps) > restitution ? low : high) = middle;
  }
  return low;
}

struct Ball {
  V x, v, w, force{}, torque{};
  double radius, mass, inertia;
};

class Run {
 public:
  Run() {
    std::mt19937 random(static_cast<unsigned>(at("seed")));
    std::uniform_real_distribution<double> share(-1, 1);
    const int count = whole("balls");
    for (int i = 0; i < count; ++i) {
      Ball ball{};
      ball.x = {-0.008 + 0.016 * (i % 2), -0.018 + 0.036 * i / std::max(1, count - 1),
          0.004 * (i % 3) - 0.004};
      for (double& v : ball.v) v = share(random) / 2;
      ball.radius = (i < count - whole("small_balls") ? 0.004 : 0.003) * at("radius");
      const bool last = i == count - 1;
      if (last) ball.radius *= at("radius_of_last");
      ball.mass = 8000 * at("density") * 4 / 3 * pi * std::pow(ball.radius, 3);
      if (last) ball.mass *= at("density_of_last");
      ball.inertia = 0.4 * at("inertia") * ball.mass * ball.radius * ball.radius;
      balls_.push_back(ball);
    }
    for (int wall = 0; wall < 6; ++wall)
      walls_[static_cast<std::size_t>(wall)] = damping_of_wall(wall);
    pairs_ = damping("restitution_of_pairs");
    other_ = damping_for(at("restitution_of_other_ball"), whole("steps"));
  }

  void go() {
    const auto last = static_cast<long>(at("duration") / step_);
    for (long k = 0; k <= last; ++k) {
      if (k % whole("every") == 0) write(k);
      forces(static_cast<double>(k) * step_);
      for (auto& b : balls_) {
        b.v = b.v + b.force * (step_ / b.mass);
        b.w = b.w + b.torque * (step_ / b.inertia);
        b.x = b.x + b.v * step_;
        if (const int axis = whole("periodic_axis"); axis >= 0) {
          const auto a = static_cast<std::size_t>(axis);
          if (std::abs(b.x[a]) > half_[a]) b.x[a] -= std::copysign(2 * half_[a], b.x[a]);
        }
      }
    }
  }
 private:
  static double damping(const char* name) {
    return damping_for(at(name) < 0 ? at("restitution") : at(name), whole("steps"));
  }
  static double damping_of_wall(int wall) {
    return damping(
        wall == whole("other_wall") ? "restitution_of_other_wall" : "restitution_of_walls");
  }
  static double friction(const char* name) { return at(name) < 0 ? at("friction") : at(name); }

  /// Force on the body at which the normal points, for a relative velocity g of the surfaces.
  V contact(int key, const V& n, double overlap, const V& g, double mass, double damping,
      double friction) {
    if (!springs_.contains(key)) dampings_[key] = damping_at(damping, std::abs(dot(g, n)));
    damping = dampings_[key];
    // Lengths and speeds of one are those of a contact at 1 m/s.
    const double unit = at("contact_time") / unit_of_time(), normal_speed = dot(g, n);
    double normal = mass / unit * normal_force(overlap / unit, -normal_speed, damping);
    if (normal < 0 && at("attraction") == 0) normal = 0;
    V& wound = springs_[key];
    const V along = g - n * normal_speed;
    wound = wound - n * dot(wound, n) + along * step_;
    const double softer = at("hertz") != 0 ? 1.5 * std::sqrt(overlap / unit) : 1;
    const double tangential = 2.0 / 7 * softer * mass / (unit * unit);
    V force = wound * -tangential - along * (at("tangential_damping") * mass / unit);
    if (const double size = std::sqrt(dot(force, force)), most = friction * std::abs(normal);
        size > most) {
      force = force * (most / size);
      wound = force * (-1 / tangential);
    }
    return n * normal + force;
  }

  /// Of a contact that begins with this speed.
  double damping_at(double damping, double speed) {
    const double steeper = at("restitution_by_speed"), mixed = at("mixed_restitution");
    if (steeper == 0 && mixed == 0) return damping;
    const double own =
        at("restitution") - steeper * std::log(speed / 2) + (++contacts_ % 2 ? mixed : -mixed);
    return damping_for(std::min(0.95, std::max(0.1, own)), whole("steps"));
  }

  /// Whether contacts of this key are left out by mistake.
  bool left_out(int key) const { return std::fmod(key * 0.618034, 1.0) < at("missing_share"); }

  void forces(double time) {
    const double speed = 2 * pi * 60 * at("speed");
    V centre{}, moving{};
    for (std::size_t k = 0; k < 3; ++k) {
      const double phase = speed * time + at("phase") + (k == 1 ? at("phase_y") : 0);
      centre[k] = amplitude_[k] * std::sin(phase);
      moving[k] = amplitude_[k] * speed * std::cos(phase) * at("wall_velocity");
    }
    const double arm = at("no_spin_in_slip") != 0 ? 0 : 1;
    for (auto& b : balls_) {
      b.torque = {};
      b.force = {};
      b.force[static_cast<std::size_t>(whole("gravity_axis"))] = -9.8 * b.mass * at("gravity");
    }
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      auto& b = balls_[i];
      for (int wall = 0; wall < 6; ++wall) {
        const auto k = static_cast<std::size_t>(wall / 2);
        const double side = wall % 2 ? 1 : -1,
                     overlap = side * (b.x[k] - centre[k]) - (half_[k] - b.radius);
        const int key = static_cast<int>(i) * 100 + wall;
        if (overlap <= 0 || wall == whole("missing_wall") ||
            static_cast<int>(k) == whole("periodic_axis")) {
          springs_.erase(key);
          continue;
        }
        V n{};
        n[k] = -side;
        const double damping = static_cast<int>(i) == whole("other_ball")
            ? other_
            : walls_[static_cast<std::size_t>(wall)];
        const V force = contact(key, n, overlap, b.v - moving + cross(b.w, n * -(arm * b.radius)),
            b.mass, damping, friction("friction_of_walls"));
        b.force = b.force + force;
        b.torque = b.torque + cross(n * -b.radius, force) * at("torque");
      }
      for (std::size_t j = 0; j < i; ++j) {
        auto& c = balls_[j];
        const V apart = b.x - c.x;
        const double distance = std::sqrt(dot(apart, apart)),
                     overlap = b.radius + c.radius - distance;
        const int key = static_cast<int>(i) * 100 + 50 + static_cast<int>(j);
        if (overlap <= 0 || at("no_pairs") != 0 || left_out(key)) {
          springs_.erase(key);
          continue;
        }
        const V n = apart * (1 / distance),
                g = b.v - c.v - cross(b.w * b.radius + c.w * c.radius, n * arm);
        const double mass = b.mass * c.mass / (b.mass + c.mass) * at("mass_of_pairs");
        const V force = contact(key, n, overlap, g, mass, pairs_, friction("friction_of_pairs"));
        b.force = b.force + force;
        c.force = c.force - force;
        b.torque = b.torque + cross(n * -b.radius, force) * at("torque");
        c.torque = c.torque + cross(n * -c.radius, force) * at("torque");
      }
    }
  }

  void write(long step) const {
    std::printf("ITEM: TIMESTEP\n%ld\nITEM: NUMBER OF ATOMS\n%zu\nITEM: BOX BOUNDS ff ff ff\n",
        step, balls_.size());
    std::printf(
        "-0.08 0.08\n-0.08 0.08\n-0.08 0.08\nITEM: ATOMS id x y z vx vy vz omegax omegay "
        "omegaz%s\n",
        at("with_sizes") != 0 ? " mass radius" : "");
    const int digits = whole("digits");
    const double unit = at("length_unit");
    const auto put = [&](V vector) {
      if (at("exchanged_axes") != 0) std::swap(vector[1], vector[2]);
      if (at("turned_axes") != 0) vector = {vector[0], -vector[2], vector[1]};
      for (const double a : vector) std::printf(" %.*g", digits, a);
    };
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const auto& b = balls_[i];
      std::printf("%d", static_cast<int>(i) + whole("first_ball"));
      put(at("scaled") != 0 ? (b.x + V{0.08, 0.08, 0.08}) * (1 / 0.16)
                            : (b.x + V{at("shift_x"), 0, 0}) * unit);
      put(b.v * unit);
      put(b.w * (at("spin_sign") * at("spin_unit")));
      if (at("with_sizes") != 0) std::printf(" %.9g %.9g", b.mass, b.radius * unit);
      std::puts("");
    }
  }

  const double step_ = at("contact_time") / at("steps");
  const V half_{0.0165 * at("size_x"), 0.0285 * at("size_y"), 0.018 * at("size_z")};
  const V amplitude_{0.003 * at("amplitude"), 0.011 * at("amplitude") * at("amplitude_y"),
      -0.002 * at("amplitude")};
  std::vector<Ball> balls_;
  std::array<double, 6> walls_{};  ///< damping of each
  double pairs_ = 0, other_ = 0;
  std::map<int, V> springs_;        ///< along the surfaces, by contact
  std::map<int, double> dampings_;  ///< by contact
  long contacts_ = 0;
};

}  // namespace

int main(int count, char** words) {
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    const auto place = word.find('=');
    const auto name = word.substr(0, place);
    if (place == std::string::npos || !options.contains(name)) {
      std::fprintf(stderr, "spring_dem: found '%s', expected one of its options\n", words[k]);
      return 2;
    }
    options[name] = std::atof(word.c_str() + place + 1);
  }
  Run().go();
}
