#include "python/tools_in_python.hpp"

#include <pybind11/stl.h>

#include <atomic>
#include <chrono>
#include <future>
#include <sstream>
#include <string>
#include <type_traits>

#include "api/case_access.hpp"
#include "base/errors.hpp"
#include "check/comparison.hpp"
#include "cli/audit_command.hpp"
#include "cli/compare_command.hpp"
#include "cli/run_case.hpp"
#include "cli/study_command.hpp"
#include "io/named_file.hpp"
#include "prove/certificate.hpp"
#include "report/report_page.hpp"

namespace py = pybind11;

namespace edmill::python {

namespace {

/// Work on a thread of its own, while this one lets Python's signal handlers run: Ctrl-C sets the flag, which
/// the work obeys, and is raised when that has ended.
template <class Work>
std::invoke_result_t<Work> interruptible(std::atomic<bool>& interrupt, const Work& work) {
  auto done = std::async(std::launch::async, work);
  bool raised = false;
  for (;;) {
    {
      const py::gil_scoped_release others;
      if (done.wait_for(std::chrono::milliseconds(100)) == std::future_status::ready) break;
    }
    if (PyErr_CheckSignals() != 0) {
      PyErr_Clear();
      raised = interrupt = true;
    }
  }
  auto result = done.get();
  if (raised) {
    PyErr_SetNone(PyExc_KeyboardInterrupt);
    throw py::error_already_set();
  }
  return result;
}

template <class Command>
int study(const std::string& file, const std::string& folder, int jobs, const Command& command) {
  std::atomic<bool> interrupt{false};
  cli::StudyOptions options{file, folder, jobs, true, &interrupt};
  return interruptible(interrupt, [&] { return command(options); });
}

int compare(const std::string& a, const std::string& b, const std::string& json, double tolerance,
            std::optional<std::uint64_t> events, std::optional<double> from, std::optional<double> until,
            std::optional<double> batch) {
  cli::CompareOptions options;
  options.a = a, options.b = b, options.json = json, options.tolerance = tolerance, options.events = events;
  options.limits.from = from, options.limits.until = until, options.batch = batch;
  options.quiet = true;
  const py::gil_scoped_release others;
  return cli::run_compare(options);
}

int audit(const Case& the_case, const std::string& log, const std::string& json,
          const std::vector<std::string>& columns, std::optional<double> tolerance,
          std::optional<double> gap_tolerance, std::optional<int> first_ball, const std::string& walls,
          bool from_start, bool identify) {
  std::atomic<bool> interrupt{false};
  cli::AuditOptions options;
  options.log = log, options.json = json, options.columns = columns, options.tolerance = tolerance;
  options.gap_tolerance = gap_tolerance, options.first_ball = first_ball, options.walls = walls;
  options.from_start = from_start, options.identify = identify;
  options.quiet = true, options.interrupt = &interrupt;
  return interruptible(interrupt, [&] { return cli::run_audit(CaseAccess::spec(the_case), options); });
}

/// @return the events as CSV, the bits of the proof and those that are left
/// @throws UndecidedError when the events cannot be proven
py::tuple prove(const Case& the_case, std::size_t collisions, long most_bits,
                const std::string& certificate) {
  std::atomic<bool> interrupt{false};
  const auto proof = interruptible(interrupt, [&] {
    return prove::prove(CaseAccess::spec(the_case), {collisions, most_bits, &interrupt, {}});
  });
  if (!proof.impossible.empty()) throw UndecidedError(proof.impossible);
  std::ostringstream events;
  prove::write_events(events, proof, 40);
  if (!certificate.empty()) {
    io::NamedFile(certificate).write([&](std::ostream& out) { prove::write_certificate(out, proof); });
  }
  return py::make_tuple(events.str(), proof.bits, proof.accuracy);
}

std::string report(const std::string& folder) {
  const py::gil_scoped_release others;
  return report::write_report(folder).string();
}

}  // namespace

void add_tools(py::module_& m) {
  m.def("sweep", [](const std::string& file, const std::string& folder, int jobs) {
    return study(file, folder, jobs, cli::run_sweep);
  });
  m.def("optimize", [](const std::string& file, const std::string& folder, int jobs) {
    return study(file, folder, jobs, cli::run_optimize);
  });
  m.def("compare", &compare);
  m.def("audit", &audit);
  m.def("prove", &prove);
  m.def("report", &report);
}

}  // namespace edmill::python
