// Materials, and the balls and walls that have them.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.hpp"
#include "casefile/case_parts.hpp"
#include "casefile/key_reader.hpp"

namespace edmill::casefile {

namespace {

std::string names_of(const CaseSpec& spec) {
  std::string names;
  for (const auto& m : spec.materials) names += (names.empty() ? "\"" : ", \"") + m.name + "\"";
  return names.empty() ? "the name of a [[material]] entry" : "one of " + names;
}

/// A ball's own density, or that of its material.
void read_density(Section& s, BallSpec& ball, const CaseSpec& spec) {
  ball.material = material_of(s, "material", ball.material_name, spec);
  if (ball.material > 0) {
    const auto& material = spec.materials[static_cast<std::size_t>(ball.material) - 1];
    if (material.density)
      ball.density = *material.density;
    else if (!s.has("density"))
      s.problem("density", "nothing, and material \"" + material.name + "\" has none",
                describe(Dimension::density));
    if (material.density && s.has("density"))
      s.problem("density", "a density beside that of material \"" + material.name + "\"", "one of them");
  }
}

/// The number of balls whose mass is nearest to that of the batch.
void count_by_mass(Section& s, BallBatch& batch) {
  if (!batch.mass || !batch.diameter.positive() || !batch.density.positive()) return;
  if (s.has("count")) return s.problem("mass", "both 'count' and 'mass'", "one of them");
  const double d = batch.diameter.to<double>();
  const double one = batch.density.to<double>() * std::numbers::pi / 6 * d * d * d;
  const double count = std::round(batch.mass->to<double>() / one);
  s.require(count <= largest_count, "mass", "that of at most " + std::to_string(largest_count) + " balls");
  batch.count = count <= largest_count ? static_cast<int>(count) : 0;
}

}  // namespace

std::optional<model::Partners> known_partners(const CaseSpec& spec) {
  try {
    return partners_of(spec);
  } catch (const InputError&) {
    return std::nullopt;
  }
}

int CaseSpec::material_named(const std::string& name) const {
  const auto found =
      std::find_if(materials.begin(), materials.end(), [&](const auto& m) { return m.name == name; });
  return found == materials.end() ? 0 : static_cast<int>(found - materials.begin()) + 1;
}

void read_material(Section& entry, CaseSpec& spec) {
  MaterialSpec material;
  read_keys(entry, material);
  entry.require(material.name.empty() || spec.material_named(material.name) == 0, "name",
                "a name that no other material has");
  // A wrong one has been reported here, and is not at the balls that have it.
  if (entry.has("density") && !(material.density && material.density->positive()))
    material.density = BallSpec{}.density;
  entry.reject_unknown_keys();
  spec.materials.push_back(std::move(material));
}

int material_of(Section& section, const std::string& key, const std::string& name, const CaseSpec& spec) {
  if (name.empty()) return 0;
  const int material = spec.material_named(name);
  section.require(material > 0, key, names_of(spec));
  return material;
}

void read_wall_materials(Section& vessel, VesselTable& table, CaseSpec& spec) {
  const int common = material_of(vessel, "material", table.material, spec);
  if (vessel.of_unknown_kind()) return;
  Section& walls = *table.materials.section;
  Named<WallName> given;
  read_keys(walls, given);
  const auto partners = known_partners(spec);
  if (!partners) return;
  spec.wall_materials.assign(static_cast<std::size_t>(partners->walls()), common);
  std::vector<bool> named(spec.wall_materials.size());
  for (const auto& key : given) {
    std::string labels;
    bool known = false;
    for (int wall = 0; wall < partners->walls(); ++wall) {
      const auto& info = (*partners)[wall];
      labels += (wall > 0 ? ", \"" : "\"") + info.label + "\"";
      if (key != info.label && key != info.key) continue;
      const auto own = static_cast<std::size_t>(wall);
      if (named[own])
        walls.problem(key, "a second material of a wall, by its key and by its label", "one of them");
      spec.wall_materials[own] = material_of(walls, key, walls.text(key).value_or(""), spec);
      named[own] = true;
      known = true;
    }
    if (!known) walls.problem(key, "a wall that the vessel does not have", "one of " + labels);
  }
}

void read_batch(Section& s, CaseSpec& spec) {
  BallBatch batch;
  batch.where = s.where();
  read_keys(s, batch);
  read_density(s, batch, spec);
  count_by_mass(s, batch);
  const bool narrow = batch.diameter_spread < batch.diameter || !batch.diameter.positive();
  s.require(narrow, "diameter_spread", "a length from 0 to less than the diameter");
  if (batch.random_speed && s.has("velocity"))
    s.problem("random_speed", "both 'velocity' and 'random_speed'", "one of them");
  s.reject_unknown_keys();
  spec.batches.push_back(std::move(batch));
}

void read_ball(Section& s, CaseSpec& spec) {
  ExplicitBall ball;
  ball.where = s.where();
  read_keys(s, ball);
  read_density(s, ball, spec);
  if (!s.has("position") && spec.initial_state.empty())
    s.problem("position", "nothing", "an array of three lengths");
  s.reject_unknown_keys();
  spec.balls.push_back(std::move(ball));
}

}  // namespace edmill::casefile
