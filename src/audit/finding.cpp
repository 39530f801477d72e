#include "audit/finding.hpp"

#include <algorithm>

namespace edmill::audit {

namespace {

constexpr std::array<KindInfo, kind_count> kinds = {{
    {"out_of_order", "s", "a line earlier than one above it", Check::order},
    {"duplicate", "s", "an impact that is logged twice", Check::order},
    {"unknown_body", "1", "a ball or wall that the case does not have", Check::bodies},
    {"not_finite", "1", "a value that is not finite, or a time of 1e15 drive periods", Check::bodies},
    {"late_event", "m", "the bodies overlap", Check::touch},
    {"early_event", "m", "the bodies do not touch yet", Check::touch},
    {"wrong_partner", "m", "another body is touched", Check::touch},
    {"rotation_order", "m", "touches in the vessel rotated in the order of the printed (2.14)", Check::touch},
    {"not_approaching", "m/s", "the bodies separate before the impact", Check::approach},
    {"normal_restitution", "m/s", "not -e_n times the approach velocity", Check::normal_law},
    {"separation_law", "m/s", "-e_n times the approach velocity where v_s applies, or the reverse",
     Check::normal_law},
    {"tangential_restitution", "m/s", "not e_t times the slip", Check::tangential_law},
    {"tangential_sign", "m/s", "the tangential impulse has the opposite sign", Check::tangential_law},
    {"unequal_balls", "m/s", "the formula for equal balls, or the shares of the other ball",
     Check::tangential_law},
    {"wall_velocity", "m/s", "the law would hold with another velocity of the wall", Check::normal_law},
    {"momentum", "m/s", "the momentum of two balls changes", Check::momentum},
    {"spin_change", "m/s", "not the torque of the impulse", Check::spin_change},
    {"approach_speed", "m/s", "differs from that of the logged states", Check::approach_speed},
    {"slip_speed", "m/s", "differs from that of the logged states", Check::slip_speed},
    {"milling_dose", "J", "not the dissipated energy", Check::milling_dose},
    {"wall_work", "J", "not the work of the wall", Check::wall_work},
    {"non_ballistic", "m", "not the end point of the free flight", Check::flight},
    {"lost_spin", "m/s", "spin changed in flight", Check::spin_kept},
    {"missed_event", "m", "an earlier impact is not logged", Check::missed},
}};

constexpr std::array<CheckInfo, check_count> checks = {{
    {"order of events", "time"},
    {"bodies and numbers", "ball, partner"},
    {"touch", "x, y, z, partner_x, partner_y, partner_z"},
    {"approach", "positions, v*_before of both"},
    {"normal restitution", "positions, v*_before and v*_after of both"},
    {"tangential restitution", "positions, v* and w*, before and after, of both"},
    {"momentum", "v*_before and v*_after of both"},
    {"torque", "positions, v* and w*, before and after"},
    {"approach speed", "approach_speed, positions, v*_before of both"},
    {"slip speed", "slip_speed, positions, v*_before and w*_before of both"},
    {"milling dose",
     "milling_dose, and positions, v* and w*, before and after, of both; or approach_speed and slip_speed"},
    {"wall work", "wall_work, positions, v*_before and v*_after"},
    {"free flight", "positions, v*_before and v*_after"},
    {"spin in flight", "w*_before and w*_after"},
    {"missed impacts", "positions, v*_after"},
}};

}  // namespace

const KindInfo& info(Kind kind) { return kinds[static_cast<std::size_t>(kind)]; }
const CheckInfo& info(Check check) { return checks[static_cast<std::size_t>(check)]; }

void Findings::add(const Finding& finding) {
  Tally& tally = tallies_[static_cast<std::size_t>(finding.kind)];
  ++tally.count;
  if (finding.explained) ++tally.explained;
  if (*finding.note != '\0') ++tally.notes[finding.note];
  keep(tally, finding);
}

void Findings::keep(Tally& tally, const Finding& finding) const {
  if (finding.size > tally.worst) tally.worst = finding.size;
  auto& worst = tally.examples;
  if (worst.size() == examples_ && !(examples_ > 0 && finding.size > worst.back().size)) return;
  const auto place = std::upper_bound(worst.begin(), worst.end(), finding,
                                      [](const Finding& a, const Finding& b) { return a.size > b.size; });
  worst.insert(place, finding);
  if (worst.size() > examples_) worst.pop_back();
}

void Findings::take(const Findings& others) {
  for (std::size_t k = 0; k < kind_count; ++k) {
    const Tally& from = others.tallies_[k];
    Tally& tally = tallies_[k];
    tally.count += from.count, tally.explained += from.explained;
    tally.worst = std::max(tally.worst, from.worst);
    for (const auto& [note, count] : from.notes) tally.notes[note] += count;
    for (const auto& finding : from.examples) keep(tally, finding);
  }
}

std::uint64_t Findings::total() const {
  std::uint64_t sum = 0;
  for (const auto& tally : tallies_) sum += tally.count;
  return sum;
}

std::uint64_t Findings::explained() const {
  std::uint64_t sum = 0;
  for (const auto& tally : tallies_) sum += tally.explained;
  return sum;
}

std::vector<Kind> Findings::ranked() const {
  std::vector<Kind> found;
  for (std::size_t k = 0; k < kind_count; ++k)
    if (tallies_[k].count > 0) found.push_back(static_cast<Kind>(k));
  std::stable_sort(found.begin(), found.end(), [&](Kind a, Kind b) { return of(a).count > of(b).count; });
  return found;
}

}  // namespace edmill::audit
