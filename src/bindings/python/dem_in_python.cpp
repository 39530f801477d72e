#include <pybind11/stl.h>

#include "dem/deck.hpp"
#include "dem/import_dump.hpp"
#include "dem/limit.hpp"
#include "io/output_folder.hpp"
#include "python/binding.hpp"
#include "run/case_access.hpp"

namespace py = pybind11;

namespace edmill::python {

namespace {

/// @return names and texts of the files, the command that runs the first, and notes
py::tuple deck_of(const Case& the_case, const std::string& code, const std::string& name, double contact_time,
                  double speed, std::optional<double> duration, std::optional<double> frames, int steps,
                  int facets) {
  const auto deck = dem::make_deck(
      CaseAccess::spec(the_case),
      {code, name, contact_time, speed, duration.value_or(0), frames.value_or(0), steps, facets});
  py::list files;
  for (const auto& file : deck.files) files.append(py::make_tuple(file.name, file.text));
  return py::make_tuple(files, deck.command, deck.notes);
}

py::dict import_dump(const Case& the_case, const std::string& dump, const std::string& out,
                     const std::string& deck, std::optional<double> time_step,
                     std::optional<std::string> units, bool in_vessel) {
  dem::ImportOptions options;
  options.dump = dump, options.deck = deck, options.time_step = time_step, options.units = units;
  options.in_vessel = in_vessel;
  const auto imported = with_interrupt(options, [&](const dem::ImportOptions& o) {
    io::NamedFile file(out);
    dem::ContactLogWriter log;
    auto result = dem::import_dump(CaseAccess::spec(the_case), o, log);
    file.write([&](std::ostream& stream) { log.write(stream, result.facts); });
    return result;
  });
  py::dict result, classes;
  const auto& facts = imported.facts;
  result["frames"] = facts.frames, result["contacts"] = facts.contacts;
  result["first"] = facts.first, result["last"] = facts.last, result["milling_dose"] = facts.dose();
  for (std::size_t k = 0; k < dem::contact_class_names.size(); ++k)
    classes[dem::contact_class_names[k]] = py::make_tuple(imported.counts[k], facts.doses[k]);
  result["classes"] = classes;
  return result;
}

const Binding dem_codes([](Module& m) {
  m.def("deck", &deck_of);
  m.def("import_dump", &import_dump);
  m.def("limit", [](const std::vector<std::string>& logs, const std::string& run, double from) {
    const Unlocked others;
    return dem::to_json(dem::limit_of(logs, run, from));
  });
});

}  // namespace

}  // namespace edmill::python
