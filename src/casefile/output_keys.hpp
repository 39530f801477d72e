// Reading of entries [[output]].
#pragma once

#include "casefile/section.hpp"

namespace edmill::casefile {

void read_spectra(Section& s, OutputSpec& output);
void read_rates_above(Section& s, OutputSpec& output);
void read_vessel_load(Section& s, OutputSpec& output);
void read_coverage(Section& s, OutputSpec& output);
void read_animation(Section& s, OutputSpec& output);
void read_snapshot(Section& s, OutputSpec& output);
void read_paraview(Section& s, OutputSpec& output);

/// Reads `interval` and `max_rows`.
void read_interval(Section& s, TimerSpec& timer, const std::optional<Quantity>& fallback = std::nullopt);
/// Size of a quantity, for comparisons between them.
double size_of(const Quantity& quantity);

/// Reads one entry and adds it to the case.
void read_output(Section entry, CaseSpec& spec);

}  // namespace edmill::casefile
