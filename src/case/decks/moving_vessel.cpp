#include "decks/moving_vessel.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

namespace edmill::decks {

namespace {

/// Corner k of the prism around a tube, at one end.
Vec3<double> corner(const model::Tube<double>& tube, int facets, int k, double height) {
  const double r = tube.radius / std::cos(numerics::pi<double>() / facets),
               angle = 2 * numerics::pi<double>() * (k + 0.5) / facets;
  return tube.frame.outside({r * std::cos(angle), height, r * std::sin(angle)});
}

void add_fan(const std::vector<Vec3<double>>& corners, std::vector<Triangle>& triangles) {
  for (std::size_t k = 2; k < corners.size(); ++k)
    triangles.push_back({corners[0], corners[k - 1], corners[k]});
}

/// A square in the plane of a disc, beyond the prism's corners.
std::vector<Vec3<double>> square_of(const model::Disc<double>& disc, int facets) {
  const double half = 1.05 * disc.radius / std::cos(numerics::pi<double>() / facets);
  std::vector<Vec3<double>> corners;
  for (const auto& [x, z] : {std::pair{-1.0, -1.0}, {1.0, -1.0}, {1.0, 1.0}, {-1.0, 1.0}})
    corners.push_back(disc.frame.outside({x * half, 0.0, z * half}));
  return corners;
}

}  // namespace

std::vector<WallMesh> meshes_of(const model::AnyVessel<double>& vessel, int facets) {
  WallMesh flat{"walls", {}, 0}, round{"side", {}, 1.01 * 360 / facets};
  bool all = true;
  for (const auto& surface : vessel.surfaces()) {
    if (const auto* tube = std::get_if<model::Tube<double>>(&surface.kind())) {
      for (int k = 0; k < facets; ++k) {
        const double low = -tube->half_height, high = tube->half_height;
        add_fan({corner(*tube, facets, k, low), corner(*tube, facets, k + 1, low),
                    corner(*tube, facets, k + 1, high), corner(*tube, facets, k, high)},
            round.triangles);
      }
    } else if (const auto* disc = std::get_if<model::Disc<double>>(&surface.kind())) {
      add_fan(square_of(*disc, facets), flat.triangles);
    } else if (std::holds_alternative<model::Zone<double>>(surface.kind()) ||
        std::holds_alternative<model::Edge<double>>(surface.kind())) {
      all = false;
    } else {
      add_fan(surface.rings().front(), flat.triangles);
    }
  }
  std::vector<WallMesh> meshes;
  if (!all) return meshes;
  for (auto* mesh : {&flat, &round})
    if (!mesh->triangles.empty()) meshes.push_back(std::move(*mesh));
  return meshes;
}

/// A body without thickness: one sheet, since triangles have two sides.
std::vector<Triangle> sheet_of(const model::RoundedBody<double>& body) {
  const auto& half = body.half();
  std::vector<Triangle> sheet;
  if (body.is_round()) {
    constexpr int sides = model::picture_sides;
    const auto corner = [&](int k) {
      const auto turn = numerics::sin_cos_turns<double>(static_cast<double>(k) / sides);
      return Vec3<double>(half[0] * turn.cos, 0, half[0] * turn.sin);
    };
    for (int k = 2; k < sides; ++k) sheet.push_back({corner(0), corner(k - 1), corner(k)});
    return sheet;
  }
  const int flat = half[0] > 0 ? half[1] > 0 ? 2 : 1 : 0;
  const auto edge = [&](int k) { return Vec3<double>(Vec3<double>::Unit(k % 3) * half[k % 3]); };
  const Vec3<double> u = edge(flat + 1), v = edge(flat + 2);
  return {{u + v, v - u, -u - v}, {u + v, -u - v, u - v}};
}

WallMesh mesh_of(const model::RoundedBody<double>& body, const std::string& name) {
  const bool is_flat = (body.half().array() == 0).any() && body.rounding() == 0;
  if (is_flat) return {name, sheet_of(body), 0};
  const auto mesh = model::mesh_of(body);
  // Angles between the facets that model::mesh_of makes, and a little more.
  WallMesh result{name, {}, body.rounding() > 0 ? 23.0 : body.is_round() ? 7.6 : 0};
  const auto point = [&](int k) { return mesh.points[static_cast<std::size_t>(k)]; };
  for (const auto& face : mesh.faces)
    for (std::size_t k = 2; k < face.size(); ++k) {
      const Triangle t{point(face[0]), point(face[k - 1]), point(face[k])};
      if (norm<double>(cross<double>(t[1] - t[0], t[2] - t[0])) > 0) result.triangles.push_back(t);
    }
  return result;
}

Vec3<double> facet_normal(const model::Tube<double>& tube, int facets, const Vec3<double>& place) {
  const auto p = tube.frame.inside(place);
  const double apart = 2 * numerics::pi<double>() / facets,
               angle = std::round(std::atan2(p[2], p[0]) / apart) * apart;
  return tube.frame.x * std::cos(angle) + tube.frame.z * std::sin(angle);
}

std::string stl_text(std::span<const WallMesh> meshes, const model::AnyMotion<double>& motion,
    const model::AnyPose<double>& pose) {
  std::string text = "solid walls\n";
  for (const auto& mesh : meshes)
    for (const auto& triangle : mesh.triangles) {
      text += " facet normal 0 0 0\n  outer loop\n";
      for (const auto& corner : triangle)
        text += fmt::format("   vertex {}\n", fmt::join(motion.to_inertial(pose, corner), " "));
      text += "  endloop\n endfacet\n";
    }
  return text + "endsolid walls\n";
}

MovingVessel::MovingVessel(const model::Mill<double>& mill,
    const std::vector<model::BallProperties<double>>& balls, int facets)
    : mill_(mill), motions_{mill.motion}, balls_(balls), clock_(mill.motion.period()),
      facets_(facets), surfaces_(mill.vessel.surfaces()) {
  for (const auto& body : mill_.bodies) motions_.emplace_back(body.motion);
  std::vector<double> radii;
  for (const auto& ball : balls_) {
    const auto k = static_cast<std::size_t>(
        std::find(radii.begin(), radii.end(), ball.radius) - radii.begin());
    inset_of_.push_back(k);
    if (k < radii.size()) continue;
    radii.push_back(ball.radius);
    insets_.push_back(mill_.vessel.inset(ball.radius));
  }
}

MovingVessel::Pose MovingVessel::at(double time) const {
  Pose poses;
  poses.reserve(motions_.size());
  for (const auto& motion : motions_) poses.push_back(motion.pose(clock_.at(time)));
  return poses;
}

const model::Tube<double>* MovingVessel::prism(int wall) const {
  return facets_ > 0 && frame_of(wall) == 0
      ? std::get_if<model::Tube<double>>(&surfaces_[static_cast<std::size_t>(wall)].kind())
      : nullptr;
}

// The gap follows from the overlap, which is a length; gap functions of vessels need not be.
double MovingVessel::gap(
    const Pose& pose, std::size_t ball, int wall, const Vector& position) const {
  const auto frame = frame_of(wall);
  const Vector place = motions_[frame].position_in_vessel(pose[frame], position);
  if (const auto* body = mill_.body_of(wall))
    return -body->shape.overlap(0, place) - balls_[ball].radius;
  if (const auto* tube = prism(wall))
    return tube->radius - balls_[ball].radius -
        dot<double>(place - tube->frame.origin, facet_normal(*tube, facets_, place));
  return -inset(ball).overlap(wall, place);
}

Vector MovingVessel::normal(
    const Pose& pose, std::size_t ball, int wall, const Vector& position) const {
  const auto frame = frame_of(wall);
  const Vector p = motions_[frame].position_in_vessel(pose[frame], position);
  const auto* body = mill_.body_of(wall);
  const auto* tube = prism(wall);
  return motions_[frame].direction_to_inertial(pose[frame],
      body       ? body->shape.normal(0, p)
          : tube ? Vector(-facet_normal(*tube, facets_, p))
                 : inset(ball).normal(wall, p));
}

double MovingVessel::energy(
    const Pose& pose, std::size_t frame, std::size_t ball, const BallState& state) const {
  const auto& b = balls_[ball];
  const auto& m = motions_[frame];
  const Vector u = m.to_vessel_frame(pose[frame], state.position, state.velocity).velocity;
  const Vector s = state.spin - m.angular_velocity(pose[frame]);
  return b.mass / 2 * squared_norm<double>(u) +
      b.reduced_inertia * b.mass * b.radius * b.radius / 2 * squared_norm<double>(s);
}

double MovingVessel::work(const Pose& poses, const BallState& before, const Pose& later,
    const BallState& after, std::size_t frame, std::size_t ball, const Vector& gravity) const {
  const auto& m = motions_[frame];
  const auto &from = poses[frame], &to = later[frame];
  // Coriolis's force does no work.
  const Vector force = m.in_axes(from, gravity - m.wall_acceleration(from, before.position)) +
      m.in_axes(to, gravity - m.wall_acceleration(to, after.position));
  const Vector way =
      m.position_in_vessel(to, after.position) - m.position_in_vessel(from, before.position);
  const auto& b = balls_[ball];
  // The torque -J w' on a spin relative to the vessel.
  const Vector turn = m.angular_velocity(to) - m.angular_velocity(from);
  const Vector spins = before.spin - m.angular_velocity(from) + after.spin - m.angular_velocity(to);
  return b.mass / 2 * dot<double>(force, way) -
      b.reduced_inertia * b.mass * b.radius * b.radius / 2 * dot<double>(turn, spins);
}

BallState MovingVessel::inertial(const Pose& poses, const BallState& seen) const {
  const auto& m = mill_.motion;
  const auto& pose = poses.front();
  const Vector place = m.to_inertial(pose, seen.position);
  return {place, m.direction_to_inertial(pose, seen.velocity) + m.wall_velocity(pose, place),
      m.direction_to_inertial(pose, seen.spin) + m.angular_velocity(pose)};
}

BallState flown(const BallState& state, const Vector& gravity, double duration) {
  return {state.position + (state.velocity + gravity * (duration / 2)) * duration,
      state.velocity + gravity * duration, state.spin};
}

}  // namespace edmill::decks
