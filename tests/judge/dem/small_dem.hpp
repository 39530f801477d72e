// A DEM code of its own, as small as one can be: balls in a box that vibrates, Hertz's contacts
// with damping, a spring along the surface up to friction, leapfrog. It shares no code with edmill.
#pragma once

#include <array>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace small_dem {

using V = std::array<double, 3>;
inline V operator+(const V& a, const V& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline V operator-(const V& a, const V& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline V operator*(const V& a, double s) { return {a[0] * s, a[1] * s, a[2] * s}; }
inline double dot(const V& a, const V& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline V cross(const V& a, const V& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const V& a) { return std::sqrt(dot(a, a)); }

/// What a deck says. Its mistakes are changes of these.
struct Deck {
  std::size_t balls = 5;
  double radius = 0.004, density = 8000;
  V half{0.0165, 0.0285, 0.018};
  V amplitude{0.003, 0.011, -0.002}, quarter{0, 0, 0};
  double frequency = 60;
  V gravity{0, -9.8, 0};
  double contact_time = 50e-6, damping = 0.4024611, friction = 0.4;
  bool attracts = false;  ///< the damping pulls bodies back that separate
  // Mistakes: a wall, or contacts of pairs, that are missing; an axis along which the box is
  // periodic; a wall with another damping; a factor of torques, and of the velocity of the walls.
  int missing_wall = -1, periodic_axis = -1, other_wall = -1;
  bool has_pairs = true;
  double other_damping = 0, torque = 1, wall_velocity = 1;
  double time_step = 1e-6, duration = 1, frames = 1e-5;
  unsigned seed = 1;
  int digits = 15;  ///< in the dump

  double mass() const { return density * 4.0 / 3 * std::acos(-1.0) * radius * radius * radius; }
};

class Run {
 public:
  explicit Run(const Deck& deck)
      : d(deck), x(d.balls), v(d.balls), w(d.balls), f(d.balls), torque(d.balls),
        springs(d.balls * (6 + d.balls)) {
    const double effective = d.mass() / std::sqrt(d.radius) * std::pow(2.868 / d.contact_time, 2.5);
    wall_stiffness = 4.0 / 3 * effective * std::sqrt(d.radius);
    pair_stiffness = 4.0 / 3 * effective * std::sqrt(d.radius / 2);
    std::mt19937 random(d.seed);
    std::uniform_real_distribution<double> share(-1, 1);
    for (std::size_t i = 0; i < d.balls; ++i)
      for (bool clear = false; !clear;) {
        for (std::size_t k = 0; k < 3; ++k) x[i][k] = share(random) * (d.half[k] - 1.5 * d.radius);
        clear = true;
        for (std::size_t j = 0; j < i; ++j) clear = clear && norm(x[i] - x[j]) > 2.1 * d.radius;
      }
  }

  /// Writes the frames as LAMMPS does.
  void write(const std::string& file) {
    std::FILE* out = std::fopen(file.c_str(), "w");
    const auto every = static_cast<long>(std::lround(d.frames / d.time_step));
    const auto steps = static_cast<long>(std::lround(d.duration / d.time_step));
    forces(0);
    for (long step = 0; step <= steps; ++step) {
      if (step % every == 0) frame(out, step);
      const double h = d.time_step;
      for (std::size_t i = 0; i < d.balls; ++i) {
        v[i] = v[i] + f[i] * (h / 2 / d.mass()), w[i] = w[i] + torque[i] * (h / 2 / inertia());
        x[i] = x[i] + v[i] * h;
        if (d.periodic_axis < 0) continue;
        const auto axis = static_cast<std::size_t>(d.periodic_axis);
        if (std::abs(x[i][axis]) > d.half[axis])
          x[i][axis] -= std::copysign(2 * d.half[axis], x[i][axis]);
      }
      forces((static_cast<double>(step) + 1) * h);
      for (std::size_t i = 0; i < d.balls; ++i)
        v[i] = v[i] + f[i] * (h / 2 / d.mass()), w[i] = w[i] + torque[i] * (h / 2 / inertia());
    }
    std::fclose(out);
  }
 private:
  double inertia() const { return 0.4 * d.mass() * d.radius * d.radius; }

  void frame(std::FILE* out, long step) const {
    std::fprintf(out,
        "ITEM: TIMESTEP\n%ld\nITEM: NUMBER OF ATOMS\n%zu\nITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 "
        "1\n-1 1\n"
        "ITEM: ATOMS vx vy vz id x y z omegax omegay omegaz mass radius\n",
        step, d.balls);
    for (std::size_t i = d.balls; i-- > 0;) {
      const auto put = [&](double a) {
        std::array<char, 40> text;
        char* end =
            std::to_chars(text.begin(), text.end(), a, std::chars_format::general, d.digits).ptr;
        *end++ = ' ';
        std::fwrite(text.data(), 1, static_cast<std::size_t>(end - text.data()), out);
      };
      for (const double a : v[i]) put(a);
      std::fprintf(out, "%zu ", i + 1);
      for (const double a : x[i]) put(a);
      for (const double a : w[i]) put(a);
      put(d.mass()), put(d.radius);
      std::fputc('\n', out);
    }
  }

  /// One contact: normal from the other body to ball i, the velocity of the surfaces, and the
  /// forces on ball i.
  V contact(V& spring, double overlap, double stiffness, double mass, double damping, const V& n,
      const V& g) {
    const double root = std::sqrt(overlap), speed = dot(g, n);
    double normal = stiffness * overlap * root -
        damping * std::sqrt(stiffness * mass) * std::sqrt(root) * speed;
    if (normal < 0 && !d.attracts) normal = 0;
    spring = spring + (g - n * speed) * d.time_step;
    spring = spring - n * dot(spring, n);
    const double along = 1.2 * stiffness * root;  // of Mindlin's order
    V tangential = spring * (-along);
    const double most = d.friction * std::abs(normal), size = norm(tangential);
    if (size > most)
      tangential = size > 0 ? tangential * (most / size) : V{}, spring = tangential * (-1 / along);
    return n * normal + tangential;
  }

  void forces(double t) {
    const double phase = 2 * std::acos(-1.0) * d.frequency, s = std::sin(phase * t),
                 c = std::cos(phase * t);
    const V centre = d.amplitude * s + d.quarter * c;
    const V moving = (d.amplitude * c - d.quarter * s) * (phase * d.wall_velocity);
    for (std::size_t i = 0; i < d.balls; ++i) f[i] = d.gravity * d.mass(), torque[i] = {};
    for (std::size_t i = 0; i < d.balls; ++i) {
      for (std::size_t wall = 0; wall < 6; ++wall) {
        const std::size_t k = wall / 2;
        const double side = wall % 2 ? 1 : -1;
        V n{};
        n[k] = -side;
        const auto here = static_cast<int>(wall);
        const bool missing = here == d.missing_wall || static_cast<int>(k) == d.periodic_axis;
        const double overlap = missing ? -1 : side * (x[i][k] - centre[k]) + d.radius - d.half[k];
        V& spring = springs[(6 + d.balls) * i + wall];
        if (overlap <= 0) {
          spring = {};
          continue;
        }
        const V g = v[i] - moving - cross(w[i], n) * d.radius;
        const double damping = here == d.other_wall ? d.other_damping : d.damping;
        const V force = contact(spring, overlap, wall_stiffness, d.mass(), damping, n, g);
        f[i] = f[i] + force, torque[i] = torque[i] - cross(n, force) * (d.radius * d.torque);
      }
      for (std::size_t j = 0; j < i && d.has_pairs; ++j) {
        const V apart = x[i] - x[j];
        V& spring = springs[(6 + d.balls) * i + 6 + j];
        if (dot(apart, apart) >= 4 * d.radius * d.radius) {
          spring = {};
          continue;
        }
        const double distance = norm(apart);
        const V n = apart * (1 / distance), g = v[i] - v[j] - cross(w[i] + w[j], n) * d.radius;
        const V force =
            contact(spring, 2 * d.radius - distance, pair_stiffness, d.mass() / 2, d.damping, n, g);
        f[i] = f[i] + force, f[j] = f[j] - force;
        const V turning = cross(n, force) * (d.radius * d.torque);
        torque[i] = torque[i] - turning, torque[j] = torque[j] - turning;
      }
    }
  }

  Deck d;
  std::vector<V> x, v, w, f, torque;
  std::vector<V> springs;  ///< of each ball with the walls and with the balls before it
  double wall_stiffness = 0, pair_stiffness = 0;
};

}  // namespace small_dem
