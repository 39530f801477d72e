#include "mill.hpp"

#include <nlohmann/json.hpp>
#include <stdexcept>

namespace checker {
namespace {

Joint read_joint(const Json& json) {
  const bool rotates = json.contains("rotate");
  with_keys(json,
      rotates ? Keys{"rotate", "angle", "frequency", "swings"}
              : Keys{"shift", "along", "speed", "swings"});
  const Vec axis = vector(json.at(rotates ? "rotate" : "along"));
  Joint joint{rotates, axis / length(axis), {}, {}, {}, {}};
  if (rotates) {
    joint.angle = number(json, "angle");
    joint.speed = number(json, "frequency");
  } else {
    joint.offset = vector(json.at("shift"));
    if (json.contains("speed")) joint.speed = number(json, "speed");
  }
  for (const Json& swing : list(json.at("swings"), 64)) {
    with_keys(swing, {"amplitude", "frequency", "phase"});
    joint.swings.push_back(
        {number(swing, "amplitude"), number(swing, "frequency"), number(swing, "phase")});
  }
  return joint;
}

std::vector<Joint> read_joints(const Json& json) {
  std::vector<Joint> joints;
  for (const Json& joint : list(json, 64)) joints.push_back(read_joint(joint));
  return joints;
}

Wall read_solid(const Json& json) {
  with_keys(json, {"solid", "half", "rounding", "joints"});
  const bool box = json.at("solid") == "box";
  if (!box && json.at("solid") != "cylinder") throw std::invalid_argument("an unknown solid");
  Wall wall{box ? Wall::solid_box : Wall::solid_cylinder, {}, {}, number(json, "rounding"),
      vector(json.at("half")), read_joints(json.at("joints"))};
  for (const Real& half : wall.half)
    if (!(half >= 0)) throw std::invalid_argument("a solid of negative size");
  if (!(wall.size >= 0)) throw std::invalid_argument("a negative rounding");
  // A cylinder is about y; both of its radii are written.
  if (!box && (!wall.half[0].positive() || json.at("half").at(0) != json.at("half").at(2)))
    throw std::invalid_argument("a cylinder that is not round");
  return wall;
}

Wall read_wall(const Json& json, bool solids) {
  if (json.contains("plane")) {
    with_keys(json, {"plane", "point", "distance"});
    return {Wall::plane, vector(json.at("plane")), vector(json.at("point")),
        number(json, "distance"), {}, {}};
  }
  if (json.contains("solid") && solids) return read_solid(json);
  const char* kind = json.contains("sphere") ? "sphere" : "cylinder";
  with_keys(json, {kind});
  return {
      json.contains("sphere") ? Wall::sphere : Wall::cylinder, {}, {}, number(json, kind), {}, {}};
}

Law read_law(const Json& json) {
  const bool walton_braun = json.at("law") == "walton-braun";
  if (!walton_braun && json.at("law") != "constant") throw std::invalid_argument("an unknown law");
  with_keys(json,
      walton_braun ? Keys{"law", "restitution", "friction", "min_tangential", "least_separation"}
                   : Keys{"law", "restitution", "restitution_tangential", "least_separation"});
  Law law{walton_braun, number(json, "restitution"),
      walton_braun ? number(json, "friction") : Real(),
      number(json, walton_braun ? "min_tangential" : "restitution_tangential"),
      number(json, "least_separation")};
  if (!(law.restitution >= 0 && law.friction >= 0 && 1 >= law.tangential &&
          law.least_separation >= 0))
    throw std::invalid_argument("law");
  return law;
}

Ball read_ball(const Json& json) {
  with_keys(
      json, {"radius", "density", "reduced_inertia", "in_vessel", "position", "velocity", "spin"});
  return {number(json, "radius"), number(json, "density"), number(json, "reduced_inertia"),
      json.at("in_vessel").get<bool>(), vector(json.at("position")), vector(json.at("velocity")),
      vector(json.at("spin"))};
}

/// For each ball, which law holds between it and each of so many bodies.
std::vector<std::vector<Index>> read_laws_of(const Json& json, Index bodies, const Mill& mill) {
  if (json.size() != mill.balls.size()) throw std::invalid_argument("laws of other balls");
  std::vector<std::vector<Index>> table;
  for (const Json& row : list(json, 4096)) {
    table.emplace_back();
    for (const Json& law : list(row, 4096)) table.back().push_back(index(law, mill.laws.size()));
    if (row.size() != bodies) throw std::invalid_argument("laws of other bodies");
  }
  return table;
}

}  // namespace

Mill read_mill(const Json& header) {
  Mill mill;
  mill.start = number(header, "start");
  mill.two_pi = pi() + pi();
  mill.gravity = vector(header.at("gravity"));
  mill.joints = read_joints(header.at("joints"));
  const bool solids = header.at("version") == 2;
  for (const Json& wall : list(header.at("walls"), 64))
    mill.walls.push_back(read_wall(wall, solids));
  for (const Json& law : list(header.at("laws"), 4096)) mill.laws.push_back(read_law(law));
  for (const Json& ball : list(header.at("balls"), 4096)) mill.balls.push_back(read_ball(ball));
  for (const Ball& ball : mill.balls)
    if (!ball.radius.positive() || !ball.density.positive() || !ball.reduced_inertia.positive())
      throw std::invalid_argument("no ball");
  mill.law_of_walls = read_laws_of(header.at("law_of_walls"), mill.walls.size(), mill);
  mill.law_of_balls = read_laws_of(header.at("law_of_balls"), mill.balls.size(), mill);
  return mill;
}

}  // namespace checker
