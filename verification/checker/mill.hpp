// The mill of a certificate: its numbers, where the vessel is, the gaps of its walls.
#pragma once

#include <nlohmann/json.hpp>
#include <set>
#include <vector>

#include "real.hpp"

namespace checker {
using Json = nlohmann::json;
using Index = std::size_t;

/// A certificate that proves nothing. What is no certificate at all is a std::exception of another kind.
struct Rejected : std::runtime_error {
  using std::runtime_error::runtime_error;
};
struct Joint {
  bool rotates;
  Vec axis, shift;
  Real angle, speed;
  std::vector<std::array<Real, 3>> swings;  ///< amplitude, frequency, phase
};
struct Wall {
  enum { plane, cylinder, sphere } kind;
  Vec outward, point;
  Real size;
};
struct Law {
  bool coulomb;
  Real restitution, friction, tangential, least;
};
struct Ball {
  Real radius, density, inertia;
  bool in_vessel;
  Vec position, velocity, spin;
};

/// An object with no other keys than these.
using Keys = std::set<std::string>;
inline const Json& known(const Json& j, const Keys& keys) {
  for (const auto& [key, value] : j.items())
    if (!keys.contains(key)) throw Rejected("rule 6: an unknown key " + Json(key).dump());
  return j;
}
inline Real number(const Json& j, const char* key) { return exact_number(j.at(key).get<std::string>()); }
inline const Json& list(const Json& j, Index most) {
  return j.is_array() && j.size() <= most ? j : throw std::invalid_argument("not a list of at most " + std::to_string(most));
}
inline Index index(const Json& j, Index count) {
  return j.is_number_unsigned() && j.get<Index>() < count ? j.get<Index>() : throw std::invalid_argument("a number too large");
}
inline Vec vector(const Json& j) {
  const auto at = [&](Index k) { return exact_number(list(j, 3).at(k).get<std::string>()); };
  return {at(0), at(1), at(2)};
}
/// docs/certificates.md, "Rules for the states": R by rows.
struct Pose {
  std::array<Vec, 3> R{Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}};
  Vec C{}, V{}, w{};
  Vec out(const Vec& v) const { return {dot(R[0], v), dot(R[1], v), dot(R[2], v)}; }
  Vec in(const Vec& v) const { return R[0] * v[0] + R[1] * v[1] + R[2] * v[2]; }
  Vec place(const Vec& r) const { return in(r - C); }
  Vec velocity(const Vec& r, const Vec& v) const { return in(v - (V + cross(w, r - C))); }
};

struct Mill {
  Real start, turn;
  Vec gravity;
  std::vector<Joint> joints;
  std::vector<Wall> walls;
  std::vector<Law> laws;
  std::vector<Ball> balls;
  std::vector<std::vector<Index>> law_of_walls, law_of_balls;
  explicit Mill(const Json& h) : start(number(h, "start")), turn(pi() + pi()), gravity(vector(h.at("gravity"))) {
    for (const auto& j : list(h.at("joints"), 64)) joints.push_back(joint(j));
    for (const auto& j : list(h.at("walls"), 64)) walls.push_back(wall(j));
    for (const auto& j : list(h.at("laws"), 4096)) laws.push_back(law(j));
    for (const auto& j : list(h.at("balls"), 4096)) {
      known(j, {"radius", "density", "reduced_inertia", "in_vessel", "position", "velocity", "spin"});
      balls.push_back({number(j, "radius"), number(j, "density"), number(j, "reduced_inertia"), j.at("in_vessel").get<bool>(),
                       vector(j.at("position")), vector(j.at("velocity")), vector(j.at("spin"))});
    }
    for (const Ball& b : balls)
      if (!b.radius.positive() || !b.density.positive() || !b.inertia.positive()) throw std::invalid_argument("no ball");
    law_of_walls = table(h.at("law_of_walls"), walls.size());
    law_of_balls = table(h.at("law_of_balls"), balls.size());
  }
  Pose pose(const Real& time) const {
    Pose p;
    for (const auto& j : joints) {
      Real value = j.angle + j.speed * (start + time), rate = j.speed, s, c;
      for (const auto& [amplitude, frequency, phase] : j.swings) {
        const Real half_turns = 2 * (frequency * (start + time) + phase);
        arb_sin_cos_pi(s.x, c.x, half_turns.x, precision);
        value = value + amplitude * s, rate = rate + amplitude * (turn * frequency) * c;
      }
      if (j.rotates) {
        p.w = p.w + p.out(j.axis) * (rate * turn);
        const Real half_turns = 2 * value;
        arb_sin_cos_pi(s.x, c.x, half_turns.x, precision);
        turn_by(p, j.axis, s, c);
      } else {
        const Vec D = p.out(j.shift + j.axis * value);
        p.V = p.V + (p.out(j.axis * rate) + cross(p.w, D)), p.C = p.C + D;
      }
    }
    return p;
  }
  /// f of a ball at the place p in the vessel frame.
  static Real gap(const Wall& w, const Ball& ball, const Vec& p) {
    const Real room = w.size - ball.radius;
    if (w.kind == Wall::plane) return root(dot(w.outward, w.outward)) * room + dot(w.outward, w.point) - dot(w.outward, p);
    return (room.positive() ? room * room : room) - dot(seen(w, p), seen(w, p));
  }
  /// f' where it moves with the velocity u there.
  static Real rate(const Wall& w, const Vec& p, const Vec& u) {
    return w.kind == Wall::plane ? 0 - dot(w.outward, u) : -2 * dot(seen(w, p), u);
  }
  /// Unit, into the vessel, in contact.
  static Vec normal(const Wall& w, const Ball& ball, const Vec& p) {
    if (w.kind == Wall::plane) return Vec{} - w.outward / root(dot(w.outward, w.outward));
    return Vec{} - seen(w, p) / (w.size - ball.radius);
  }

 private:
  /// A cylinder does not see y.
  static Vec seen(const Wall& w, const Vec& p) { return {p[0], w.kind == Wall::cylinder ? Real() : p[1], p[2]}; }
  static void turn_by(Pose& p, const Vec& e, const Real& s, const Real& c) {
    std::array<Vec, 3> E, product;
    for (Index k = 0, l = 1, m = 2; k < 3; ++k, l = (k + 1) % 3, m = (k + 2) % 3) {
      E[k][k] = e[k] * e[k] + c * (1 - e[k] * e[k]);
      E[k][l] = e[k] * e[l] * (1 - c) - e[m] * s;
      E[l][k] = e[k] * e[l] * (1 - c) + e[m] * s;
    }
    for (Index k = 0; k < 3; ++k) product[k] = E[0] * p.R[k][0] + E[1] * p.R[k][1] + E[2] * p.R[k][2];
    p.R = product;
  }
  static Joint joint(const Json& j) {
    const bool rotates = j.contains("rotate");
    known(j, rotates ? Keys{"rotate", "angle", "frequency", "swings"} : Keys{"shift", "along", "speed", "swings"});
    const Vec axis = vector(j.at(rotates ? "rotate" : "along")), shift = rotates ? Vec{} : vector(j.at("shift"));
    Joint result{rotates, axis / root(dot(axis, axis)), shift, {}, j.contains("speed") ? number(j, "speed") : Real(), {}};
    if (rotates) result.angle = number(j, "angle"), result.speed = number(j, "frequency");
    for (const auto& s : list(j.at("swings"), 64))
      known(s, {"amplitude", "frequency", "phase"}),
          result.swings.push_back({number(s, "amplitude"), number(s, "frequency"), number(s, "phase")});
    return result;
  }
  static Wall wall(const Json& j) {
    const bool plane = j.contains("plane"), sphere = j.contains("sphere");
    known(j, plane ? Keys{"plane", "point", "distance"} : sphere ? Keys{"sphere"} : Keys{"cylinder"});
    if (plane) return {Wall::plane, vector(j.at("plane")), vector(j.at("point")), number(j, "distance")};
    if (sphere) return {Wall::sphere, {}, {}, number(j, "sphere")};
    return {Wall::cylinder, {}, {}, number(j, "cylinder")};
  }
  static Law law(const Json& j) {
    const bool coulomb = j.at("law") == "walton-braun";
    if (!coulomb && j.at("law") != "constant") throw std::invalid_argument("an unknown law");
    known(j, coulomb ? Keys{"law", "restitution", "friction", "min_tangential", "least_separation"}
                     : Keys{"law", "restitution", "restitution_tangential", "least_separation"});
    const Law l{coulomb, number(j, "restitution"), coulomb ? number(j, "friction") : Real(),
                number(j, coulomb ? "min_tangential" : "restitution_tangential"), number(j, "least_separation")};
    return l.restitution >= 0 && l.friction >= 0 && 1 >= l.tangential && l.least >= 0 ? l : throw std::invalid_argument("law");
  }
  std::vector<std::vector<Index>> table(const Json& j, Index columns) const {
    std::vector<std::vector<Index>> rows;
    for (const auto& row : j.size() == balls.size() ? list(j, 4096) : throw std::invalid_argument("laws of other balls")) {
      rows.emplace_back();
      for (const auto& law : list(row, 4096)) rows.back().push_back(index(law, laws.size()));
      if (row.size() != columns) throw std::invalid_argument("laws of other bodies");
    }
    return rows;
  }
};

}  // namespace checker
