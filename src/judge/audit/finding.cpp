#include "audit/finding.hpp"

#include <algorithm>

namespace edmill::audit {

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
    tally.count += from.count;
    tally.explained += from.explained;
    tally.worst = std::max(tally.worst, from.worst);
    for (const auto& [note, count] : from.notes) tally.notes[note] += count;
    for (const auto& finding : from.examples) keep(tally, finding);
  }
}

std::uint64_t Findings::sum(std::uint64_t Tally::*number) const {
  std::uint64_t sum = 0;
  for (const auto& tally : tallies_) sum += tally.*number;
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
