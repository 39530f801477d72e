// YADE 2023: infinite planes where the vessel only translates, else triangles that turn about the point at
// rest.
#include <fmt/format.h>

#include <cmath>

#include "base/errors.hpp"
#include "dem/deck.hpp"
#include "dem/soft_contact.hpp"
#include "dem/wall_mesh.hpp"

namespace edmill::dem {

namespace {

/// Planes across the axes, which move as the vessel does.
std::string planes_of(const DeckCase& c, const model::BoxVessel<double>& box) {
  const auto formulas = displacement_formulas(c, "t");
  return fmt::format(R"(HALF = ({}, {}, {})
def place(t): return Vector3({}, {}, {})
walls = []
for axis in range(3):
    for side in (-1, 1):
        home = [side*HALF[k] if k == axis else 0.0 for k in range(3)]
        walls.append(O.bodies.append(wall(place(BEGIN)+Vector3(home), axis, sense=-side, material=walls_material)))
def drive():
    # Newton's law moves everything to the end of the step afterwards.
    t = BEGIN+O.time+O.dt
    for i in walls: O.bodies[i].state.vel = (place(t)-place(t-O.dt))/O.dt
shapes = [Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()]
moves = []
)",
                     box.half[0], box.half[1], box.half[2], formulas[0], formulas[1], formulas[2]);
}

/// Triangles with the velocity of a rigid body that turns about the point of it that is at rest.
std::string triangles_of(const DeckCase& c, const std::string& file) {
  return fmt::format(R"(from yade import ymport
{}
walls = O.bodies.append(ymport.stl('{}', material=walls_material))
turn = RotationEngine(ids=walls, rotateAroundZero=True, zeroPoint=(0, 0, 0), angularVelocity=0, rotationAxis=(1, 0, 0))
def drive():
    R, C, w, dw, V, A = pose(BEGIN+O.time+O.dt/2)
    size = np.linalg.norm(w)
    if size < 1e-9: turn.angularVelocity = 0; return
    turn.zeroPoint = Vector3(*(C+cross(w, V)/size**2))
    turn.angularVelocity, turn.rotationAxis = size, Vector3(*(w/size))
shapes = [Bo1_Sphere_Aabb(), Bo1_Facet_Aabb()], [Ig2_Sphere_Sphere_ScGeom(), Ig2_Facet_Sphere_ScGeom()]
moves = [turn]
)",
                     pose_in_python(c), file);
}

/// Whether the vessel's centre moves across its angular velocity at all times that are tried, so that a point
/// of it is at rest.
bool turns_about_a_point(const DeckCase& c) {
  const auto& motion = c.mill.motion;
  const DriveClock<double> clock(motion.period());
  for (int k = 0; k < 64; ++k) {
    const auto pose = motion.pose(clock.at(c.begin + c.period * k / 64));
    const Vec3<double> spin = motion.angular_velocity(pose);
    const Vec3<double> centre = motion.to_inertial(pose, Vec3<double>::Zero());
    const Vec3<double> velocity = motion.wall_velocity(pose, centre);
    const double size = norm<double>(spin);
    if (norm<double>(velocity) > 1e-12 && !(size > 1e-9)) return false;
    if (std::abs(dot<double>(spin, velocity)) > 1e-9 * (1 + size * norm<double>(velocity))) return false;
  }
  return true;
}

std::string bodies_of(const DeckCase& c) {
  std::string text = "BALLS = [  # position, radius, density, velocity, spin\n";
  for (std::size_t k = 0; k < c.balls.size(); ++k) {
    const auto& [x, v, w] = c.states[k];
    text += fmt::format("    (({}, {}, {}), {}, {}, ({}, {}, {}), ({}, {}, {})),\n", x[0], x[1], x[2],
                        c.balls[k].radius, c.density(k), v[0], v[1], v[2], w[0], w[1], w[2]);
  }
  return text + R"(]
balls, materials = [], {}
for x, r, density, v, w in BALLS:
    if density not in materials: materials[density] = O.materials.append(material_of(density, FRICTION))
    i = O.bodies.append(sphere(x, r, material=materials[density]))
    s = O.bodies[i].state
    s.vel, s.angVel = Vector3(v), Vector3(w)
    s.angMom = s.inertia[0]*Vector3(w)
    balls.append(i)
)";
}

std::string engines_of(const DeckCase& c, const DeckOptions& options) {
  const auto& g = c.mill.gravity;
  return fmt::format(R"(frames = open('{0}.dump', 'w')
def dump():
    # The bodies have moved to the end of the step, the clock has not.
    frames.write('ITEM: UNITS\nsi\nITEM: TIME\n%.15g\nITEM: TIMESTEP\n%d\nITEM: NUMBER OF ATOMS\n%d\n' % (O.time+O.dt, O.iter+1, len(balls)))
    frames.write('ITEM: BOX BOUNDS ff ff ff\n-1 1\n-1 1\n-1 1\nITEM: ATOMS id x y z vx vy vz omegax omegay omegaz mass radius\n')
    for k, i in enumerate(balls):
        s = O.bodies[i].state
        frames.write('%d %s\n' % (k+1, ' '.join('%.15g' % a for a in (*s.pos, *s.vel, *s.angVel, s.mass, BALLS[k][1]))))
ids = list(O.materials)
ball_ids = [m.id for m in ids if m.id != walls_material]
def table(of_balls, of_walls):
    return MatchMaker(matches=[(i, j, of_balls) for i in ball_ids for j in ball_ids]+[(i, walls_material, of_walls) for i in ball_ids])
contacts = Ip2_FrictMat_FrictMat_MindlinPhys(en=table({1:.9g}, {2:.9g}), es=1.0, frictAngle=table(atan(FRICTION), atan(WALL_FRICTION)))
O.engines = [ForceResetter(), InsertionSortCollider(shapes[0], verletDist={3:.6g}),
             InteractionLoop(shapes[1], [contacts], [Law2_ScGeom_MindlinPhys_Mindlin()]),
             PyRunner(command='drive()', iterPeriod=1)]+moves+[
             NewtonIntegrator(damping=0, gravity=({4}, {5}, {6})),
             PyRunner(command='dump()', iterPeriod={7})]
O.dt = {8}
O.run({9}, wait=True)
frames.close()
O.exitNoBacktrace()
)",
                     options.name, formula_restitution(c.of_balls.damping),
                     formula_restitution(c.of_walls.damping), c.largest_radius / 2, g[0], g[1], g[2],
                     c.frame_every, c.time_step, c.steps);
}

}  // namespace

Deck yade_deck(const DeckCase& c, const DeckOptions& options) {
  const auto* box = c.mill.vessel.get_if<model::BoxVessel<double>>();
  const bool planes = box && c.translates();
  const auto meshes = meshes_of(c.mill.vessel, options.facets);
  if (!planes && (meshes.empty() || !turns_about_a_point(c)))
    throw InputError(fmt::format(
        "{}: found a {}, expected a box that translates, or flat walls or a cylinder about a point at "
        "rest, which YADE's engines move",
        c.file,
        meshes.empty() ? "vessel with walls that are round in two ways" : "motion along its own axis"));
  Deck deck;
  if (!planes) {
    deck.files.push_back({options.name + "_walls.stl", stl_text(meshes, c.mill.motion, c.pose)});
    deck.notes = notes_on(meshes, options.facets);
  }
  std::string text = header_of(c, options) + facts_of(meshes, options.facets);
  text += fmt::format(R"(from math import *
import numpy as np
BEGIN, FRICTION, WALL_FRICTION = {}, {}, {}
def material_of(density, friction):
    return FrictMat(young={:.12g}, poisson={}, density=density, frictionAngle=atan(friction))
# A contact has the smaller friction of its bodies, unless both are told.
walls_material = O.materials.append(material_of(8000, WALL_FRICTION))
)",
                      c.begin, c.of_balls.friction, c.of_walls.friction, c.young, DeckCase::poisson);
  text += bodies_of(c) + (planes ? planes_of(c, *box) : triangles_of(c, options.name + "_walls.stl"));
  text += engines_of(c, options);
  deck.files.insert(deck.files.begin(), {options.name + ".py", std::move(text)});
  deck.command = fmt::format("yade -n -x -j1 {}.py", options.name);
  return deck;
}

}  // namespace edmill::dem
