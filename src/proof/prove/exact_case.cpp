#include "prove/exact_case.hpp"

#include <flint/fmpq.h>

#include <filesystem>
#include <optional>

#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "base/scalar_list.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case.hpp"
#include "casefile/rational.hpp"
#include "prove/enclosure.hpp"

namespace edmill::prove {

namespace {

using boost::multiprecision::cpp_int;
using casefile::CaseSpec;

/// The joints of a motion, without swings of zero amplitude: a certificate lists no zeros.
ExactJoints moving_joints(ExactJoints joints) {
  for (auto& joint : joints) {
    if (joint.axis[0].zero() && joint.axis[1].zero() && joint.axis[2].zero()) joint.axis[0] = 1;
    std::erase_if(joint.swings, [](const auto& swing) { return swing.amplitude.zero(); });
  }
  return joints;
}

/// A plane across an axis, at this distance from the origin, on its negative (-1) or positive side.
ExactWall plane(std::size_t axis, int side, const Quantity& distance) {
  ExactWall wall;
  wall.normal[axis] = side;
  wall.size = distance;
  return wall;
}
ExactWall round_wall(ExactWall::Kind kind, const Quantity& diameter) {
  return {kind, {}, {}, diameter / 2, {}, {}};
}

/// The walls of a vessel in order, and half its sizes if it can be filled with balls at random.
struct Vessel {
  std::vector<ExactWall> walls;
  std::optional<QuantityVector> half;
};

Vessel vessel_of(const model::Cylinder<Quantity>& v) {
  const Quantity half = v.height / 2, radius = v.diameter / 2;
  return {{plane(1, -1, half), plane(1, 1, half), round_wall(ExactWall::cylinder, v.diameter)},
      QuantityVector{radius, half, radius}};
}
Vessel vessel_of(const model::Box<Quantity>& v) {
  Vessel vessel{{}, QuantityVector{}};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Quantity half = v.size[axis] / 2;
    (*vessel.half)[axis] = half;
    for (const int side : {-1, 1}) vessel.walls.push_back(plane(axis, side, half));
  }
  return vessel;
}
Vessel vessel_of(const model::Sphere<Quantity>& v) {
  const Quantity radius = v.diameter / 2;
  return {{round_wall(ExactWall::sphere, v.diameter)}, QuantityVector{radius, radius, radius}};
}
Vessel vessel_of(const model::Polyhedron<Quantity>& v) {
  Vessel vessel;
  for (const auto& face : v.faces)
    vessel.walls.push_back({ExactWall::plane, face.normal, face.point, face.distance, {}, {}});
  return vessel;
}
template <class Other> Vessel vessel_of(const Other& other) {
  throw InputError(std::string("[vessel] type: found \"") + other.name +
      "\", expected one with walls that are planes, a cylinder or a sphere: `prove` supports no "
      "others");
}

ExactLaw law_of(const casefile::ContactSpec& spec, const std::string& file) {
  const auto& v_s = spec.least_separation;
  if (const auto* walton = std::get_if<model::WaltonBraun<Quantity>>(&spec.law))
    return {true, walton->normal, walton->min_tangential, walton->friction, v_s};
  if (const auto* constant = std::get_if<model::ConstantRestitution<Quantity>>(&spec.law))
    return {false, constant->normal, constant->tangential, Quantity(), v_s};
  throw InputError(file + ": key 'contact.model': found \"" + spec.name() +
      "\", expected \"walton-braun\" or \"constant\": `prove` supports no others");
}

/// Index of the law of two materials: 0 between balls, 1 with walls, then those of pairs.
std::size_t law_between(const CaseSpec& spec, int one, int other, std::size_t otherwise) {
  for (std::size_t k = 0; k < spec.pairs.size(); ++k)
    if (spec.pairs[k].is_of(one, other)) return k + 2;
  return otherwise;
}

void fill_laws(const CaseSpec& spec, const std::vector<int>& materials, ExactCase& result) {
  std::vector<bool> used(spec.pairs.size() + 2);
  const auto use = [&](std::size_t law) {
    used[law] = true;
    return law;
  };
  const auto& own = spec.wall_materials;
  for (const int one : materials) {
    auto& walls = result.law_of_walls.emplace_back();
    for (std::size_t wall = 0; wall < result.walls.size(); ++wall)
      walls.push_back(use(law_between(spec, one, wall < own.size() ? own[wall] : 0, 1)));
    auto& balls = result.law_of_balls.emplace_back();
    for (const int other : materials) balls.push_back(use(law_between(spec, one, other, 0)));
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    const auto& law = k == 0 ? spec.ball_ball : k == 1 ? spec.ball_wall : spec.pairs[k - 2].law;
    result.laws.push_back(used[k] ? law_of(law, spec.file) : ExactLaw{});
  }
}

/// The exact position of a ball placed at random: its coordinates are multiples of 2^-52 of the
/// room for its centre, recovered from a placement in many digits, in the thread's precision.
QuantityVector exact_place(const Vec3<mpfr>& local, QuantityVector room, const std::string& where) {
  for (int axis = 0; auto& size : room) {
    const mpfr steps = ldexp(local[axis++] / size.to<mpfr>(), 52), whole = round(steps);
    if (!(abs(steps - whole) < 1e-100))
      throw InputError(
          where + ": found balls whose places are not known exactly, expected a position for each");
    const cpp_int number(static_cast<std::int64_t>(whole));
    size = size * casefile::quantity_of({number, cpp_int(1) << 52});
  }
  return room;
}

ExactBall ball_of(const casefile::BallSpec& spec) {
  return {.radius = spec.diameter / 2,
      .density = spec.density,
      .reduced_inertia = spec.reduced_inertia,
      .velocity = spec.velocity};
}

void add_batches(const CaseSpec& spec, const std::optional<QuantityVector>& half,
    std::vector<int>& materials, ExactCase& result) {
  if (spec.batches.empty()) return;
  const mpfr::Digits digits(placing_digits);
  const auto built = casefile::build_case<mpfr>(spec, false);
  const auto& motion = built.the_case.mill.motion;
  const auto pose = motion.pose(built.start);
  for (const auto& batch : spec.batches) {
    if (!half || batch.diameter_spread.positive() || batch.random_speed)
      throw InputError(batch.where +
          ": found random diameters, random velocities or a polyhedron to fill, expected balls "
          "with position "
          "and velocity: `prove` needs exact ones");
    for (int k = 0; k < batch.count; ++k) {
      ExactBall ball = ball_of(batch);
      QuantityVector room = *half;
      const auto edge = rational(ball.radius) + rational(batch.gap_wall);
      for (auto& size : room) size = casefile::quantity_of(rational(size) - edge);
      ball.in_vessel = true;
      const auto& state = built.states[result.balls.size()];
      const auto local = motion.position_in_vessel(pose, state.position);
      ball.position = exact_place(local, room, batch.where);
      result.balls.push_back(ball);
      materials.push_back(batch.material);
    }
  }
}

}  // namespace

ExactCase exact_case(const CaseSpec& spec) {
  if (!spec.pistons.empty())
    throw InputError(
        spec.file + ": [[piston]]: `prove` does not support walls that move in the vessel");
  if (!spec.initial_state.empty())
    throw InputError(spec.file +
        ": key 'run.initial_state': found a saved state, expected balls described in the case");
  ExactCase result;
  result.name = one_line(std::filesystem::path(spec.file).filename().string());
  result.digest = spec.digest;
  result.start = spec.initial_time;
  result.gravity = spec.gravity;
  result.joints = moving_joints(casefile::joints_of(spec.mill));
  auto vessel = std::visit([](const auto& v) { return vessel_of(v); }, spec.vessel);
  result.walls = std::move(vessel.walls);
  for (const auto& body : spec.bodies) {
    const auto kind = body.is_round ? ExactWall::solid_cylinder : ExactWall::solid_box;
    const auto joints = moving_joints(casefile::joints_from_ground(body, spec));
    result.walls.push_back({kind, {}, {}, body.rounding, body.core(), joints});
  }
  std::vector<int> materials;
  for (const auto& given : spec.balls) {
    ExactBall ball = ball_of(given);
    ball.position = given.position;
    ball.spin = given.spin;
    result.balls.push_back(ball);
    materials.push_back(given.material);
  }
  add_batches(spec, vessel.half, materials, result);
  fill_laws(spec, materials, result);
  return result;
}

Enclosure enclosure_of(const casefile::Quantity& quantity) {
  Enclosure result;
  fmpq_t ratio;
  fmpq_init(ratio);
  fmpq_set_str(ratio, casefile::rational(quantity).str().c_str(), 10);
  arb_set_fmpq(result.arb(), ratio, Precision::bits());
  fmpq_clear(ratio);
  if (quantity.pi_power == 0) return result;
  Enclosure pi;
  arb_const_pi(pi.arb(), Precision::bits());
  for (int k = 0; k < quantity.pi_power; ++k) result *= pi;
  for (int k = 0; k > quantity.pi_power; --k) result /= pi;
  return result;
}

}  // namespace edmill::prove
