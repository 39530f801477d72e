#include "dem/deck.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/parts.hpp"
#include "dem/soft_contact.hpp"

namespace edmill::dem {

namespace {

SoftLaw soft_law(const model::ContactLaw<double>& law, const std::string& file, const DeckOptions& options) {
  if (law.name() != std::string("walton-braun"))
    throw InputError(
        fmt::format("{}: key 'contact.model': found \"{}\", expected \"walton-braun\": a deck has "
                    "contacts of one restitution and friction",
                    file, law.name()));
  SoftLaw soft{};
  law.parameters([&](const model::Parameter& p, double value) {
    if (p.key == std::string("restitution")) soft.restitution = value;
    if (p.key == std::string("friction")) soft.friction = value;
  });
  if (soft.restitution < 0.05)
    throw InputError(
        fmt::format("{}: key 'contact.restitution': found {}, expected 0.05 or more: with less the "
                    "contacts of DEM codes stick",
                    file, soft.restitution));
  soft.damping = damping_for(soft.restitution, options.steps,
                             options.code == "yade" ? Separation::attracts : Separation::free);
  return soft;
}

void refuse_what_no_code_has(const casefile::CaseSpec& spec, const casefile::InitialCase<double>& built) {
  std::vector<std::string> problems;
  const auto problem = [&](const std::string& found, const std::string& expected) {
    problems.push_back(fmt::format("{}: found {}, expected {}", spec.file, found, expected));
  };
  if (!spec.pistons.empty())
    problem("pistons", "walls that move together: no deck has walls that move apart");
  if (!spec.pairs.empty()) problem("laws of pairs of materials", "one law between balls and one at walls");
  for (const auto& ball : built.the_case.balls)
    if (std::abs(ball.reduced_inertia - 0.4) > 1e-12) {
      problem(fmt::format("a reduced inertia of {}", ball.reduced_inertia),
              "0.4: DEM codes have solid spheres");
      break;
    }
  if (!problems.empty()) throw InputError(problems);
}

}  // namespace

double DeckCase::density(std::size_t ball) const {
  const double r = balls[ball].radius;
  // As it was given: the mass came from it.
  return std::stod(fmt::format("{:.14g}", balls[ball].mass / (4.0 / 3 * numerics::pi<double>() * r * r * r)));
}

bool DeckCase::translates() const {
  return std::ranges::none_of(joints.list, &model::Joint<double>::rotates);
}

std::string header_of(const DeckCase& c, const DeckOptions& options) {
  return fmt::format(
      "# {} of edmill {}: contacts of {:g} s at {:g} m/s, restitution {:g} (balls) and {:g} (walls)\n"
      "# digest of the case {}\n",
      c.file, version(), options.contact_time, options.speed, c.of_balls.restitution, c.of_walls.restitution,
      c.digest);
}

std::string weight_of(const DeckCase& c) {
  const auto& g = c.mill.gravity;
  const double size = norm<double>(g);
  if (!(size > 0)) return "";
  return fmt::format("fix weight all gravity {} vector {} {} {}\n", size, g[0] / size, g[1] / size,
                     g[2] / size);
}

std::array<double, 3> axis_of(const model::Joint<double>& joint) {
  auto axis = joint.axis;
  const double length = std::hypot(axis[0], axis[1], axis[2]);
  for (double& part : axis) part = length > 0 ? part / length : 0;
  return axis;
}

std::array<std::string, 3> displacement_formulas(const DeckCase& c, const std::string& time) {
  std::array<std::string, 3> sums;
  const auto add = [&](std::size_t k, const std::string& term) {
    sums[k] += (sums[k].empty() ? "" : "+") + term;
  };
  for (const auto& joint : c.joints.list) {
    const auto axis = axis_of(joint);
    for (std::size_t k = 0; k < 3; ++k) {
      if (joint.shift[k] != 0) add(k, fmt::format("{}", joint.shift[k]));
      if (axis[k] == 0) continue;
      if (joint.speed != 0) add(k, fmt::format("{}*{}", axis[k] * joint.speed, time));
      for (const auto& s : joint.swings)
        if (s.amplitude != 0)
          add(k, fmt::format("{}*sin({}*{}+{})", axis[k] * s.amplitude, turn * s.frequency, time,
                             turn * s.phase));
    }
  }
  for (auto& sum : sums)
    if (sum.empty()) sum = "0.0";
  return sums;
}

std::string pose_in_python(const DeckCase& c) {
  std::string joints;
  for (const auto& j : c.joints.list) {
    std::string swings;
    for (const auto& s : j.swings)
      swings += fmt::format("({}, {}, {}), ", j.rotates ? turn * s.amplitude : s.amplitude,
                            turn * s.frequency, turn * s.phase);
    joints += fmt::format("    ({}, np.array([{}]), np.array([{}]), {}, {}, [{}]),\n",
                          j.rotates ? "True" : "False", fmt::join(axis_of(j), ", "), fmt::join(j.shift, ", "),
                          turn * j.angle, j.rotates ? turn * j.speed : j.speed, swings);
  }
  return fmt::format(
      R"(from math import cos, sin
# rotates, axis, shift, angle, speed, swings (amplitude, angular speed, phase): from the ground to the vessel
JOINTS = [
{}]
def cross(a, b):
    a, b = a.tolist(), b.tolist()  # sooner than np.cross
    return np.array((a[1]*b[2]-a[2]*b[1], a[2]*b[0]-a[0]*b[2], a[0]*b[1]-a[1]*b[0]))
def skew(n):
    x, y, z = n.tolist()
    return np.array(((0, -z, y), (z, 0, -x), (-y, x, 0)))
def turned(n, q):
    K = skew(n)
    return np.eye(3)+sin(q)*K+(1-cos(q))*(K @ K)
def pose(t):
    R, C, w, dw, V, A = np.eye(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3), np.zeros(3)
    for rotates, axis, shift, angle, speed, swings in JOINTS:
        q, q1, q2 = angle+speed*t, speed, 0.0
        for a, f, p in swings:
            q, q1, q2 = q+a*sin(f*t+p), q1+a*f*cos(f*t+p), q2-a*f*f*sin(f*t+p)
        if rotates:
            n = R @ axis
            dw = dw+q2*n+q1*cross(w, n)
            w = w+q1*n
            R = R @ turned(axis, q)
        else:
            d, v, a = R @ (shift+axis*q), R @ (axis*q1), R @ (axis*q2)
            A = A+a+2*cross(w, v)+cross(dw, d)+cross(w, cross(w, d))
            V = V+v+cross(w, d)
            C = C+d
    return R, C, w, dw, V, A)",
      joints);
}

Deck make_deck(const casefile::CaseSpec& spec, const DeckOptions& options) {
  const auto built = casefile::build_case<double>(spec);
  refuse_what_no_code_has(spec, built);
  const auto& c = built.the_case;
  const DriveClock<double> clock(c.mill.motion.period());
  const double begin = clock.seconds(built.start), time_step = options.contact_time / options.steps;
  const double duration = options.duration > 0 ? options.duration
                          : spec.end_time      ? spec.end_time->to<double>() - begin
                                               : 0;
  const double interval = options.frame_interval > 0 ? options.frame_interval : options.contact_time / 5;
  const auto& largest = *std::ranges::max_element(c.balls, {}, &model::BallProperties<double>::radius);
  const DeckCase deck{
      .file = spec.file,
      .digest = spec.digest,
      .balls = c.balls,
      .states = built.states,
      .of_balls = soft_law(c.mill.ball_ball, spec.file, options),
      .of_walls = soft_law(c.mill.ball_wall, spec.file, options),
      .mill = c.mill,
      .joints = model::converted_joints<double>(
          model::Joints<casefile::Quantity>{casefile::joints_of(spec.mill), casefile::period_of(spec.mill)},
          [](const casefile::Quantity& q) { return q.to<double>(); }),
      .begin = begin,
      .period = casefile::period_of(spec.mill).to<double>(),
      .pose = c.mill.motion.pose(clock.at(begin)),
      .young =
          young_for(options.contact_time, options.speed, largest.radius, largest.mass, DeckCase::poisson),
      .time_step = time_step,
      .steps = std::lround(duration / time_step),
      .frame_every = std::max(1L, std::lround(interval / time_step)),
      .largest_radius = largest.radius};
  if (!(duration > 0))
    throw InputError(spec.file + ": found no run.end_time and no --duration, expected one of them");
  if (options.code == "lammps") return lammps_deck(deck, options);
  auto filled = options;
  // A ball at an edge between two triangles of YADE touches both, so that they must be few.
  if (filled.facets == 0) filled.facets = options.code == "yade" ? 24 : 128;
  return options.code == "liggghts" ? liggghts_deck(deck, filled) : yade_deck(deck, filled);
}

}  // namespace edmill::dem
