#include <fmt/format.h>

#include <algorithm>

#include "casefile/build_case.hpp"
#include "casefile/case_parts.hpp"

namespace edmill::casefile {

using PistonSpec = model::Piston<Quantity>;

namespace {

/// Displacements of a piston between two times at most [m].
struct Travel {
  double least, most;
};

Travel travel_of(const PistonSpec& piston, double from, double to) {
  const double begin = piston.distance.to<double>() + piston.speed.to<double>() * from;
  const double end = piston.distance.to<double>() + piston.speed.to<double>() * to;
  double swings = 0;
  for (const auto& s : piston.swings) swings += std::abs(s.amplitude.to<double>());
  return {std::min(begin, end) - swings, std::max(begin, end) + swings};
}

double largest_diameter(const CaseSpec& spec) {
  double largest = 0;
  for (const auto& b : spec.balls) largest = std::max(largest, b.diameter.to<double>());
  for (const auto& b : spec.batches)
    largest = std::max(largest, b.diameter.to<double>() + b.diameter_spread.to<double>());
  return largest;
}

using PolyhedronVessel = model::PolyhedronVessel<double>;

/// Whether the wall can move along its normal and leave its neighbours as they are.
bool can_move(const model::AnyVessel<double>& vessel, int wall) {
  if (vessel.get_if<PolyhedronVessel>()) return true;
  return vessel.is_flat(wall) && vessel.function_count() == vessel.wall_count();
}

/// From a flat wall to what is opposite [m].
double depth_of(const model::AnyVessel<double>& vessel, int wall) {
  const Vec3<double> origin = Vec3<double>::Zero(), normal = vessel.normal(wall, origin);
  return vessel.gap(wall, origin) + dot<double>(normal.cwiseAbs(), vessel.half_sizes());
}

/// Even with all pistons as far inward as they go, the largest ball has room at the origin.
void require_room(Section& entry, const PolyhedronVessel& polyhedron, const std::vector<PistonSpec>& pistons,
                  double from, double to, double diameter) {
  auto planes = polyhedron.planes();
  for (const auto& piston : pistons)
    planes[static_cast<std::size_t>(piston.wall)].distance -= travel_of(piston, from, to).most;
  for (const auto& plane : planes)
    if (plane.distance < diameter / 2)
      return entry.problem(
          "wall", fmt::format("pistons or walls that come as near as {:g} m to the origin", plane.distance),
          fmt::format("room for a ball of {:g} m there all the time", diameter));
}

}  // namespace

void read_pistons(Section& vessel, Entries<PistonTable>& entries, CaseSpec& spec) {
  if (entries.empty() || vessel.of_unknown_kind()) return;
  const auto known = known_partners(spec);
  if (!known) return entries.clear();
  const auto& partners = *known;
  const auto built = build_vessel<double>(spec.vessel);
  for (Section& entry : entries) {
    PistonTable table;
    read_keys(entry, table);
    PistonSpec piston{-1, table.distance, table.speed, read_swings(table.swings)};
    std::string flat;
    for (int wall = 0; wall < partners.walls(); ++wall) {
      if (!can_move(built, wall)) continue;
      flat += (flat.empty() ? "one of \"" : ", \"") + partners[wall].label + "\"";
      if (table.wall == partners[wall].label || table.wall == partners[wall].key) piston.wall = wall;
    }
    entry.require(piston.wall >= 0, "wall", flat.empty() ? "a vessel with flat walls and sharp edges" : flat);
    for (const auto& other : spec.pistons)
      entry.require(other.wall != piston.wall || piston.wall < 0, "wall", "one piston for each wall");
    if (piston.distance.zero() && piston.speed.zero() && piston.swings.empty())
      entry.problem(first_of(entry, {"speed", "distance", "wall"}), "a piston that does not move",
                    "one with distance, speed or swing");
    entry.reject_unknown_keys();
    spec.pistons.push_back(std::move(piston));
  }
}

void require_travel(std::vector<Section>& entries, const CaseSpec& spec) {
  if (std::any_of(spec.pistons.begin(), spec.pistons.end(), [](const auto& p) { return p.wall < 0; })) return;
  if (entries.empty()) return;
  const auto vessel = build_mill<double>(spec).vessel;
  const double from = spec.initial_time.to<double>();
  const double diameter = largest_diameter(spec);
  for (std::size_t k = 0; k < spec.pistons.size(); ++k) {
    const auto& piston = spec.pistons[k];
    if (!piston.speed.zero() && !spec.end_time) {
      entries[k].problem("speed", "a piston that moves on and on", "a run.end_time");
      continue;
    }
    const double to = spec.end_time ? spec.end_time->to<double>() : from;
    const auto own = travel_of(piston, from, to);
    const double depth = depth_of(vessel, piston.wall);
    if (own.least < -1e-14 * depth)  // what is left is rounding
      entries[k].problem("wall", fmt::format("a piston that leaves the vessel by {:g} m", -own.least),
                         "a distance from which its speed and swings do not bring it out");
    if (const auto* polyhedron = vessel.get_if<PolyhedronVessel>()) {
      if (k == 0) require_room(entries[k], *polyhedron, spec.pistons, from, to, diameter);
      continue;
    }
    double room = depth - own.most;
    const auto normal = [&](int wall) { return vessel.normal(wall, Vec3<double>::Zero()); };
    for (std::size_t other = 0; other < spec.pistons.size(); ++other)
      if (dot<double>(normal(piston.wall), normal(spec.pistons[other].wall)) < -0.5)
        room -= travel_of(spec.pistons[other], from, to).most;
    if (room < diameter)
      entries[k].problem(
          "wall", fmt::format("a piston that meets the other end: it leaves {:g} m", std::max(room, 0.0)),
          fmt::format("room for a ball of {:g} m all the time", diameter));
  }
}

std::string describe(const PistonSpec& piston) {
  std::string text = fmt::format("{:g} m", piston.distance.to<double>());
  if (!piston.speed.zero())
    text += fmt::format(" {} {:g} m/s t", piston.speed.negative() ? '-' : '+',
                        std::abs(piston.speed.to<double>()));
  return text + equation_of(piston.swings, false) + " inward";
}

}  // namespace edmill::casefile
