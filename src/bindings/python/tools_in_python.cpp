#include <pybind11/stl.h>

#include <atomic>
#include <sstream>
#include <string>
#include <tuple>

#include "app/certify.hpp"
#include "app/judge.hpp"
#include "app/run.hpp"
#include "app/study.hpp"
#include "base/clean_text.hpp"
#include "base/errors.hpp"
#include "casefile/quantity.hpp"
#include "decks/deck.hpp"
#include "dem/contact_rates.hpp"
#include "dem/contacts.hpp"
#include "dem/import_dump.hpp"
#include "machines/machines.hpp"
#include "model/impact_record.hpp"
#include "model/variables.hpp"
#include "prove/proof.hpp"
#include "python/binding.hpp"
#include "report/report_page.hpp"
#include "run/case_access.hpp"
#include "run/run_folder.hpp"
#include "run/sensitivity.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace edmill::python {

namespace {

using Text = const std::string&;
using Texts = const std::vector<std::string>&;
using MaybeNumber = std::optional<double>;

/// @return how many runs failed
template <std::optional<app::StudyResult> (*command)(const app::StudyOptions&)>
std::size_t study(Text file, Text folder, int jobs, const py::object& progress) {
  app::StudyOptions options{file, folder, jobs, true};
  if (!progress.is_none())
    options.progress = [&](std::size_t done, std::size_t total) {
      const Locked python;
      progress(done, total);  // it raises nothing
    };
  const auto result = with_interrupt(options, command);
  return result ? result->counts.failed : 0;
}

/// This one and the next return the result in JSON.
std::string compare(Text a, Text b, MaybeNumber tolerance, std::optional<std::uint64_t> events,
    MaybeNumber from, MaybeNumber until, MaybeNumber batch, MaybeNumber within) {
  return app::compare({a, b, {from, until}, batch, tolerance, events, within}).json;
}

std::string audit(const Case& the_case, Text log, Texts columns, MaybeNumber tolerance,
    MaybeNumber gap_tolerance, std::optional<int> first_ball, Text walls, bool from_start,
    bool identify) {
  const app::AuditOptions options{
      log, columns, tolerance, gap_tolerance, first_ball, walls, from_start, identify};
  return with_interrupt(options, app::audit, CaseAccess::spec(the_case)).json;
}

py::str name_of(std::size_t quantity) {
  const auto& name = model::logged_quantities[quantity].name;
  return {name.data(), name.size()};
}

py::dict digits_of(const app::Agreement& agreement) {
  py::dict digits;
  for (std::size_t k = 0; k < model::logged_count; ++k) {
    const double found = agreement.digits(k);  // None where no difference at all was seen
    digits[name_of(k)] = found < app::Agreement::most ? py::cast(found) : py::none();
  }
  return digits;
}

py::list bodies_of(const std::vector<run::Event>& events) {
  py::list rows;
  for (const auto& e : events) {
    const auto* kind = e.with_wall ? "wall" : "ball";
    py::dict row("ball"_a = e.ball, "partner_kind"_a = kind, "partner"_a = e.partner);
    for (std::size_t k = 0; k < model::logged_count; ++k) row[name_of(k)] = e[k].str();
    rows.append(row);
  }
  return rows;
}

/// @return the agreement of each pair of scalars, and the events, numbers as texts of all digits
py::tuple certify(const Case& the_case, std::size_t collisions, int digits, Text file) {
  const app::CertifyOptions options{file, collisions, digits};
  const auto found = with_interrupt(options, app::certify, CaseAccess::spec(the_case));
  if (!found.undecided.empty()) throw UndecidedError(found.undecided);
  py::list evidence;
  for (const auto& pair : found.evidence)
    evidence.append(
        py::make_tuple(pair.narrow, pair.wide, pair.agreement.events(), digits_of(pair.agreement)));
  return py::make_tuple(evidence, bodies_of(found.events));
}

py::dict shadow(const Case& the_case, Text precision, Text wider) {
  app::require_wider(precision, wider, "wider");
  const auto found = with_interrupt([&](const std::atomic<bool>* flag) {
    return app::shadow(CaseAccess::spec(the_case), precision, wider, flag);
  });
  py::object diverged = py::none();
  if (found.diverged) diverged = bodies_of({found.diverged->first, found.diverged->second});
  return py::dict("events"_a = found.agreement.events(), "digits"_a = digits_of(found.agreement),
      "digits_lost_per_event"_a = found.agreement.digits_lost_per_event(), "diverged"_a = diverged,
      "text"_a = found.text());
}

/// @return the precision, the units, the events, and for each parameter of `by`, event after event
/// and as texts, the derivatives of the event's quantities and of the states of its bodies
py::tuple sensitivity(const Case& the_case, Texts by, std::size_t events, unsigned digits) {
  const run::SensitivityOptions options{.by = by, .events = events, .digits = digits, .file = ""};
  const auto found = with_interrupt(options, run::sensitivity, CaseAccess::spec(the_case));
  py::list of_numbers;
  for (std::size_t k = 0; k < by.size(); ++k) {
    std::vector<std::string> quantities, states;
    const auto put = [&](std::vector<std::string>& list, const mpfr& x) {
      list.push_back(x.str(static_cast<int>(digits)));
    };
    for (const auto& event : found.derivatives) {
      const auto& d = event[k];
      for (const auto& value : d.values) put(quantities, value);
      for (const auto& t : d.states_after)
        for (const auto* vector : {&t.position, &t.velocity, &t.spin})
          for (int axis = 0; axis < 3; ++axis) put(states, (*vector)[axis]);
    }
    of_numbers.append(py::make_tuple(quantities, states));
  }
  return py::make_tuple(found.precision, found.units, bodies_of(found.events), of_numbers);
}

/// @return the precision that gives the digits required, and the case with those that it gives
py::tuple find_digits(const Case& the_case) {
  const auto found =
      with_interrupt(app::DigitsOptions(), app::find_digits, CaseAccess::spec(the_case));
  if (!found.undecided.empty()) throw UndecidedError(found.undecided);
  auto spec = CaseAccess::spec(the_case);
  spec.right_digits = found.right();
  return py::make_tuple(found.precision, CaseAccess::make(std::move(spec)));
}

py::dict estimate(const Case& the_case, Text precision) {
  const auto found = with_interrupt(
      app::DigitsOptions(), app::estimate_run, CaseAccess::spec(the_case), precision);
  const double verifying =
      found.verifying > 0 ? found.trials + found.verifying * found.cpu_seconds() : 0;
  return py::dict("precision"_a = found.precision, "events"_a = found.events,
      "digits_lost_per_event"_a = found.lost_per_event, "right_events"_a = found.right_events,
      "cpu_seconds"_a = found.cpu_seconds(), "verifying_cpu_seconds"_a = verifying,
      "bytes"_a = found.bytes);
}

/// @return the events as CSV, the bits of the proof, and the bits that remain at its end
py::tuple prove(const Case& the_case, std::size_t collisions, long most_bits, Text certificate) {
  const app::ProveOptions options{
      {.collisions = collisions, .most_bits = most_bits, .progress = nullptr}, "", certificate};
  const auto proof = with_interrupt(options, app::prove, CaseAccess::spec(the_case));
  if (!proof.impossible.empty()) throw UndecidedError(proof.impossible);
  std::ostringstream events;
  prove::write_events(events, proof, 40);
  return py::make_tuple(events.str(), proof.bits, proof.accuracy);
}

/// @throws KeyboardInterrupt when Ctrl-C ended it, with its state on disk
void in_folder(const app::RunOptions& options, const auto& work, const auto&... arguments) {
  const auto result = with_interrupt(options, work, arguments...);
  if (result.end_reason == model::EndReason::undecided) throw UndecidedError(result.error);
}

void run_with_checkpoints(
    const Case& the_case, Text precision, Text folder, bool report, Text interval) {
  const auto& spec = CaseAccess::spec(the_case);
  run::parse_checkpoint_interval(interval);
  app::RunOptions options;
  options.folder = folder;
  options.report = report;
  options.checkpoint = app::first_checkpoint(spec, precision, report, interval);
  in_folder(options, app::run, precision, spec);
}

void resume(Text folder, Text interval) {
  if (!interval.empty()) run::parse_checkpoint_interval(interval);
  app::RunOptions options;
  options.folder = folder;
  in_folder(options, app::resume, interval);
}

/// @return names and texts of the files, the command that runs the first, and notes
py::tuple deck_of(const Case& the_case, Text code, Text name, double contact_time, double speed,
    MaybeNumber duration, MaybeNumber frames, int steps, int facets) {
  const auto deck = decks::make_deck(CaseAccess::spec(the_case),
      {code, name, contact_time, speed, duration.value_or(0), frames.value_or(0), steps, facets});
  py::list files;
  for (const auto& file : deck.files) files.append(py::make_tuple(file.name, file.text));
  return py::make_tuple(files, deck.command, deck.notes);
}

py::dict import_dump(const Case& the_case, Text dump, Text out, Text deck, MaybeNumber time_step,
    std::optional<std::string> units, bool in_vessel) {
  dem::ImportOptions options{
      .dump = dump, .log = out, .deck = deck, .time_step = time_step, .units = units};
  options.in_vessel = in_vessel;
  const auto imported = with_interrupt(options, dem::import_dump, CaseAccess::spec(the_case));
  py::dict classes;
  const auto& facts = imported.facts;
  for (std::size_t k = 0; k < dem::contact_class_names.size(); ++k)
    classes[dem::contact_class_names[k]] = py::make_tuple(imported.counts[k], facts.doses[k]);
  return py::dict("frames"_a = facts.frames, "contacts"_a = facts.contacts, "first"_a = facts.first,
      "last"_a = facts.last, "milling_dose"_a = facts.dose(), "classes"_a = classes);
}

py::list machines_in_python() {
  py::list all;
  for (const auto& m : machines::catalogue().machines) {
    py::list rows;
    for (const auto& s : m.settings) rows.append(py::make_tuple(s.key, s.value, s.source));
    all.append(py::make_tuple(m.key, rows));
  }
  return all;
}

std::string new_case(Text machine, Texts balls, Text powder, Text speed, Text restitution,
    Text friction, Text target_dose, Text time, Text jar, Text fill, Text ratio) {
  return machines::new_case(
      {machine, balls, powder, speed, restitution, friction, target_dose, time, jar, fill, ratio});
}

/// @return whether a run failed, and the common result of the seeds
std::pair<bool, std::string> seeds(
    Text file, Texts settings, Text precision, std::uint64_t count, Text folder, int jobs) {
  const app::SeedsOptions options{{file, folder, jobs, true}, settings, precision, count};
  const auto result = with_interrupt(options, app::seeds);
  return {result && result->counts.failed > 0, result ? result->optimum : ""};
}

/// @return for the case as it is and for each variation: its description, its dose rate with
/// half-width, and whether it differs; and the table
py::tuple vary(const Case& the_case, double uncertainty) {
  const auto& spec = CaseAccess::spec(the_case);
  const auto found = with_interrupt([&](const std::atomic<bool>* flag) {
    const auto run = run::make_run(spec.precision, spec, {.interrupt = flag});
    run->finish();
    return app::vary(spec, spec.precision, study::record_of(run->facts()), uncertainty, flag);
  });
  py::list rows;
  for (const auto& v : found.runs)
    rows.append(py::make_tuple(v.what, v.record.facts.find("milling_dose_rate"),
        v.record.facts.find("intervals/milling_dose_rate"), v.differs));
  return py::make_tuple(rows, found.text());
}

const Binding tools([](Module& m) {
  m.def("with_interval", &with_interval);
  m.def("in_si", &casefile::in_si);
  m.def("seeds", &seeds);
  m.def("vary", &vary);
  m.def("sweep", &study<app::sweep>);
  m.def("optimize", &study<app::optimize>);
  m.def<Unlocked>("compare", &compare);
  m.def("audit", &audit);
  m.def("prove", &prove);
  m.def<Unlocked>("check_certificate", [](const Case& the_case, Text certificate) {
    return app::check_certificate(CaseAccess::spec(the_case), certificate);
  });
  m.def("certify", &certify);
  m.def("shadow", &shadow);
  m.def<Unlocked>(
      "check", [](const Case& the_case) { return app::check(CaseAccess::spec(the_case)).facts; });
  m.def("sensitivity", &sensitivity);
  py::tuple quantities(std::size_t{model::logged_count});
  for (std::size_t k = 0; k < model::logged_count; ++k) quantities[k] = name_of(k);
  m.attr("logged_quantities") = quantities;
  m.def("find_digits", &find_digits);
  m.def("estimate", &estimate);
  m.def<Unlocked>("report", [](Text folder) { return report::write_report(folder).string(); });
  m.def<Unlocked>(
      "report_of_runs", [](Texts folders, Text file) { report::write_comparison(folders, file); });
  m.def("run_with_checkpoints", &run_with_checkpoints);
  m.def("resume", &resume);
  m.def("deck", &deck_of);
  m.def("import_dump", &import_dump);
  m.def<Unlocked>("limit", [](Texts logs, Text run, double from) {
    return dem::to_json(dem::limit_of(logs, run, from));
  });
  m.def("machines", &machines_in_python);
  m.def("new_case", &new_case);
  m.def("variables", [] {
    std::vector<std::tuple<std::string, std::string, std::string>> rows;
    for (const auto& v : model::impact_variables) rows.emplace_back(v.name, v.unit, v.meaning);
    return rows;
  });
});

}  // namespace

}  // namespace edmill::python
