#include <algorithm>

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

void read_material(Section entry, CaseSpec& spec) {
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

int read_material_of(Section& section, const std::string& key, const CaseSpec& spec) {
  const auto name = section.text(key);
  if (!name) return 0;
  const int material = spec.material_named(*name);
  section.require(material > 0, key, names_of(spec));
  return material;
}

void read_wall_materials(Section& vessel, CaseSpec& spec) {
  const int common = read_material_of(vessel, "material", spec);
  if (vessel.of_unknown_kind()) return;
  Section walls = vessel.section("materials");
  const auto partners = known_partners(spec);
  if (!partners) return;
  spec.wall_materials.assign(static_cast<std::size_t>(partners->walls()), common);
  std::vector<bool> named(spec.wall_materials.size());
  for (const auto& key : walls.keys()) {
    std::string labels;
    bool known = false;
    for (int wall = 0; wall < partners->walls(); ++wall) {
      const auto& info = (*partners)[wall];
      labels += (wall > 0 ? ", \"" : "\"") + info.label + "\"";
      if (key != info.label && key != info.key) continue;
      const auto own = static_cast<std::size_t>(wall);
      if (named[own])
        walls.problem(key, "a second material of a wall, by its key and by its label", "one of them");
      spec.wall_materials[own] = read_material_of(walls, key, spec);
      named[own] = true;
      known = true;
    }
    if (!known) walls.problem(key, "a wall that the vessel does not have", "one of " + labels);
  }
}

}  // namespace edmill::casefile
