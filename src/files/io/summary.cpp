#include "io/summary.hpp"

#include <algorithm>

#include "base/scalar_list.hpp"
#include "base/statistics.hpp"
#include "io/json_text.hpp"

namespace edmill::io {

namespace {

/// Writes a summary, a group of keys a function, in the order of the file.
template <class Real>
class SummaryWriter {
 public:
  explicit SummaryWriter(const Summary<Real>& summary) : s(summary) {}

  std::string text() {
    add_run();
    add_collisions();
    add_doses();
    add_energy();
    add_touched();
    add_intervals();
    if (s.target) add_target();
    if (s.collapse) add_collapse();
    if (s.stall) add_stall();
    add_engine();
    return json.finish();
  }

 private:
  void add_run() {
    json.text("format", "edmill summary 1");
    const auto& p = s.provenance;
    json.text("version", p.version);
    json.text("commit", p.commit);
    json.text("compiler", p.compiler);
    json.text("case_file", p.case_file);
    json.text("case_digest", p.case_digest);
    json.texts("settings", p.settings);
    json.flag("reported", p.reported);
    json.integer("seed", p.seed);
    json.text("precision", p.precision);
    if (p.right_digits) json.integer("right_digits", *p.right_digits);
    json.text("end_reason", std::string(model::name(s.end_reason)));
    if (!s.error.empty()) json.text("error", s.error);
    json.number("start_time", s.start_time);
    json.number("end_time", s.end_time);
    json.number("duration", s.duration());
  }

  void add_collisions() {
    json.begin("collisions");
    for (int k = 0; k < s.partners.count(); ++k) json.integer(s.partners[k].key, s.collisions[k]);
    json.integer("total", s.total_collisions());
    json.end();
    json.begin("collision_rate");
    for (int k = 0; k < s.partners.count(); ++k)
      rate(s.partners[k].key, Real(static_cast<std::int64_t>(s.collisions[k])));
    rate("total", Real(static_cast<std::int64_t>(s.total_collisions())));
    json.end();
  }

  void add_doses() {
    json.number("milling_dose", s.milling_dose);
    rate("milling_dose_rate", s.milling_dose);
    json.number("inverse_milling_dose_rate", s.duration() > 0 && s.milling_dose > 0
                                                 ? std::optional<Real>(s.duration() / s.milling_dose)
                                                 : std::nullopt);
    json.begin("milling_dose_by_partner");
    for (int k = 0; k < s.partners.count(); ++k) json.number(s.partners[k].key, s.dose_by_partner[k]);
    json.end();
    if (!s.powder_mass) return;
    json.number("powder_mass", *s.powder_mass);
    json.number("charge_ratio", Real(*s.ball_mass / *s.powder_mass));
    json.number("specific_milling_dose", Real(s.milling_dose / *s.powder_mass));
    rate("specific_milling_dose_rate", Real(s.milling_dose / *s.powder_mass));
  }

  void add_energy() {
    json.number("wall_work", s.wall_work);
    rate("wall_work_rate", s.wall_work);
    json.begin("energy");
    json.number("kinetic_start", s.energy_at_start.kinetic);
    json.number("potential_start", s.energy_at_start.potential);
    json.number("kinetic_end", s.energy_at_end.kinetic);
    json.number("potential_end", s.energy_at_end.potential);
    json.number("closure", s.energy_closure);
    json.number("closure_relative", Real(s.energy_closure / s.energy_scale()));
    json.end();
  }

  void add_touched() {
    json.begin("least_separation");
    add_shares(s.touched_impacts, s.touched_dose);
    json.number("supplied_energy", s.supplied_energy);
    json.number("supplied_energy_share",
                s.energy_scale() > 0 ? Real(s.supplied_energy / s.energy_scale()) : Real(0));
    json.end();
    json.begin("stalls");
    add_shares(s.stall_impacts, s.stall_dose);
    json.end();
  }

  /// Half-widths of the rates above, under their names.
  void add_intervals() {
    json.begin("intervals");
    json.integer("batches", s.intervals.batches);
    json.number("batch_length", s.intervals.batch_length);
    if (s.intervals.any()) {
      const auto& i = s.intervals;
      json.number("milling_dose_rate", i.dose_rate.half_width);
      const Real rate = s.milling_dose / s.duration();
      if (s.milling_dose > 0)
        json.number("inverse_milling_dose_rate", i.dose_rate.half_width / static_cast<double>(rate * rate));
      if (s.powder_mass)
        json.number("specific_milling_dose_rate",
                    i.dose_rate.half_width / static_cast<double>(*s.powder_mass));
      json.number("wall_work_rate", i.wall_work_rate.half_width);
      put_by_partner("collision_rate", i.collision_rates, i.collision_rate);
      put_by_partner("milling_dose_rate_by_partner", i.dose_rates, i.dose_rate);
      json.numbers("milling_dose_rate_of_batches", i.dose_rate.means);
    }
    json.end();
    json.begin("warnings");
    for (const auto& warning : s.warnings) json.text(warning.kind, warning.text);
    json.end();
  }
  void put_by_partner(std::string_view key, const std::vector<Intervals::Rate>& rates,
                      const Intervals::Rate& total) {
    json.begin(key);
    for (int k = 0; k < s.partners.count(); ++k) json.number(s.partners[k].key, rates[k].half_width);
    json.number("total", total.half_width);
    json.end();
  }

  void add_target() {
    json.begin("target");
    json.number("dose", s.target->dose);
    json.text("counts", s.target->counts);
    json.number("counted_dose_rate", s.target->counted_dose_rate);
    if (s.intervals.any())
      json.number("counted_dose_rate_half_width", s.intervals.counted_dose_rate.half_width);
    json.number("milling_time", s.milling_time());
    if (const auto width = s.milling_time_half_width()) json.number("milling_time_half_width", *width);
    json.end();
  }

  void add_shares(std::uint64_t impacts, const Real& dose) {
    const auto total = static_cast<double>(s.total_collisions());
    json.integer("impacts", impacts);
    json.number("impact_share", total > 0 ? static_cast<double>(impacts) / total : 0.0);
    json.number("milling_dose", dose);
    json.number("milling_dose_share", s.milling_dose > 0 ? Real(dose / s.milling_dose) : Real(0));
  }
  void add_collapse() {
    json.begin("inelastic_collapse");
    json.integer("ball", s.collapse->ball);
    json.text("partner_kind", s.collapse->with_wall ? "wall" : "ball");
    json.integer("partner", s.collapse->partner);
    json.number("accumulation_time", s.collapse->accumulation_time);
    json.end();
  }

  void add_stall() {
    json.begin("stalled");
    json.number("time", s.stall->time);
    json.integers("balls", s.stall->balls);
    json.integers("walls", s.stall->walls);
    json.integer("impacts", s.stall->impacts);
    json.end();
  }

  void add_engine() {
    if (!s.notes.empty()) {
      json.begin("notes");
      for (const auto& [name, value] : s.notes) json.number(name, value);
      json.end();
    }
    json.begin("escalations");
    for (const auto& e : s.escalations) {
      json.begin(e.scalar);
      json.integer("wall", e.wall);
      json.integer("pair", e.pair);
      json.integer("order", e.order);
      json.end();
    }
    json.end();
    json.integer("simultaneous_contacts", s.simultaneous_contacts);
    json.number("deepest_overlap", s.deepest_overlap);
    json.integer("impacts_since_start", s.total_impacts);
    json.number("cpu_seconds", s.cpu_seconds);
    json.number("collisions_per_cpu_second",
                s.cpu_seconds > 0 ? static_cast<double>(s.total_impacts) / s.cpu_seconds : 0.0);
  }

  /// The amount over the time simulated; null when that is none.
  void rate(std::string_view key, const Real& amount) {
    json.number(key, s.duration() > 0 ? std::optional<Real>(amount / s.duration()) : std::nullopt);
  }

  const Summary<Real>& s;
  JsonText json;
};

}  // namespace

template <class Real>
Summary<double> in_double(const Summary<Real>& s) {
  const auto real = [](const Real& x) { return static_cast<double>(x); };
  const auto maybe = [&](const std::optional<Real>& x) { return x ? std::optional(real(*x)) : std::nullopt; };
  Summary<double> d(s.partners);
  d.provenance = s.provenance, d.end_reason = s.end_reason, d.error = s.error;
  d.start_time = real(s.start_time), d.end_time = real(s.end_time), d.period = real(s.period);
  d.collisions = s.collisions;
  std::transform(s.dose_by_partner.begin(), s.dose_by_partner.end(), d.dose_by_partner.begin(), real);
  d.milling_dose = real(s.milling_dose), d.wall_work = real(s.wall_work);
  d.energy_at_start = {real(s.energy_at_start.kinetic), real(s.energy_at_start.potential)};
  d.energy_at_end = {real(s.energy_at_end.kinetic), real(s.energy_at_end.potential)};
  d.energy_closure = real(s.energy_closure);
  d.touched_impacts = s.touched_impacts, d.touched_dose = real(s.touched_dose);
  d.supplied_energy = real(s.supplied_energy);
  d.stall_impacts = s.stall_impacts, d.stall_dose = real(s.stall_dose);
  if (const auto& c = s.collapse)
    d.collapse = {c->ball, c->with_wall, c->partner, real(c->accumulation_time)};
  if (const auto& stall = s.stall) d.stall = {real(stall->time), stall->balls, stall->walls, stall->impacts};
  d.escalations = s.escalations;
  d.powder_mass = maybe(s.powder_mass), d.ball_mass = maybe(s.ball_mass);
  d.simultaneous_contacts = s.simultaneous_contacts, d.deepest_overlap = real(s.deepest_overlap);
  d.cpu_seconds = s.cpu_seconds, d.total_impacts = s.total_impacts;
  for (const auto& [name, value] : s.notes) d.notes.emplace_back(name, real(value));
  d.intervals = s.intervals, d.warnings = s.warnings, d.wanted_precision = s.wanted_precision;
  if (const auto& t = s.target) d.target = {real(t->dose), t->counts, real(t->counted_dose_rate)};
  return d;
}

template <class Real>
std::string stall_message(const Summary<Real>& s) {
  std::string bodies;
  const auto add = [&](const std::string& body) { bodies += (bodies.empty() ? "" : ", ") + body; };
  constexpr std::size_t most = 8;
  for (std::size_t k = 0; k < std::min(most, s.stall->balls.size()); ++k)
    add("ball " + std::to_string(s.stall->balls[k]));
  if (s.stall->balls.size() > most) add(std::to_string(s.stall->balls.size() - most) + " more balls");
  for (const int wall : s.stall->walls)
    add("wall " + std::to_string(wall) + " (" + s.partners[wall].label + ")");
  return "the run has stalled at " + to_text<Real>(s.stall->time) + " s: " + bodies + " hit each other " +
         std::to_string(s.stall->impacts) +
         " times while the clock stood still, and no motion separates them; give them room (fewer or smaller "
         "balls, a piston that ends its way earlier), or let the run end before";
}

template <class Real>
std::string summary_json(const Summary<Real>& s) {
  return SummaryWriter<Real>(s).text();
}

Intervals::Rate Intervals::of(std::vector<double> amounts, double length) {
  for (auto& amount : amounts) amount /= length;
  const double half_width = numerics::estimate(amounts).half_width.value_or(0);
  return {std::move(amounts), half_width};
}

#define EDMILL_SUMMARY(Real)                                      \
  template std::string summary_json<Real>(const Summary<Real>&);  \
  template std::string stall_message<Real>(const Summary<Real>&); \
  template Summary<double> in_double<Real>(const Summary<Real>&);
EDMILL_FOR_EACH_SCALAR(EDMILL_SUMMARY)

}  // namespace edmill::io
