// What follows from the fields of a summary, whatever the scalar of its run.
#include <algorithm>

#include "io/summary.hpp"

namespace edmill::io {

namespace {

/// At an end of the record, the larger one [J].
double kinetic_energy(const Facts& f) {
  return std::max(f.number("energy/kinetic_start"), f.number("energy/kinetic_end"));
}

}  // namespace

model::EndReason end_reason_of(const Facts& f) {
  constexpr const char *key = "end_reason", *expected = "why the run ended";
  const auto reason = model::end_reason_named(f.text(key, expected));
  if (!reason) throw f.wrong(key, expected);
  return *reason;
}

const char* energy_scale_of(const Facts& f) {
  return f.number("milling_dose") < kinetic_energy(f) ? "kinetic energy" : "dose";
}

bool has_dose(const Facts& f) {
  const double dose = f.number("milling_dose");
  return dose * 1e9 > std::max(dose, kinetic_energy(f));
}

}  // namespace edmill::io
