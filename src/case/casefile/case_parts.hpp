// Sections of a case file that have a source file of their own.
#pragma once

#include "casefile/case_spec.hpp"
#include "casefile/section.hpp"
#include "casefile/tables.hpp"

namespace edmill::casefile {

/// What the balls can collide with, unless the vessel is none, which has been reported.
std::optional<model::Partners> known_partners(const CaseSpec& spec);
/// An entry [[material]].
void read_material(Section& entry, CaseSpec& spec);
/// The material of a name that a key gives; 0 where there is none or, which is reported, it is unknown.
int material_of(Section& section, const std::string& key, const std::string& name, const CaseSpec& spec);
/// vessel.material and [vessel.materials].
void read_wall_materials(Section& vessel, VesselTable& table, CaseSpec& spec);
/// [[mill.joint]]; what is wrong is reported.
model::Joints<Quantity> read_joints(Section& mill);
/// Reports translations at constant speed, which only the end of a run bounds.
void require_end(Section& mill);
/// [[...swing]] of a joint or a piston; what is wrong is reported.
std::vector<model::Swing<Quantity>> read_swings(Entries<SwingTable>& entries);
/// Reports speeds that a file could not give.
void check_swings(Section& section, const std::vector<model::Swing<Quantity>>& swings);
/// [[vessel.piston]]
void read_pistons(Section& vessel, Entries<PistonTable>& entries, CaseSpec& spec);
/// Reports pistons that leave the vessel or meet the other end.
void require_travel(std::vector<Section>& entries, const CaseSpec& spec);
/// [contact], [contact.ball_ball], [contact.ball_wall] and [[contact.pair]].
/// @pre all that they may refer to has been read: materials, vessel, powder and balls
void read_contact(Section& contact, CaseSpec& spec);
/// What a file may give a part, a law or a ball, asked of values from no file: reports what it would refuse.
void check(Section mill, const MotionSpec& motion);
void check(Section vessel, const VesselSpec& shape);
void check(Section contact, const ContactSpec& law, const CaseSpec& spec);
/// An entry [[ball]].
void read_ball(Section& entry, CaseSpec& spec);
/// An entry [[balls]].
void read_batch(Section& entry, CaseSpec& spec);

}  // namespace edmill::casefile
