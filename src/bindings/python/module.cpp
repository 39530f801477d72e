// The extension module edmill._edmill: cases, runs, studies and judges of the library as plain
// Python values. The package edmill beside it is what users import. Here are cases and runs.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "casefile/case_spec.hpp"
#include "edmill/case.hpp"
#include "edmill/errors.hpp"
#include "python/binding.hpp"
#include "report/report_page.hpp"
#include "run/any_run.hpp"
#include "run/case_access.hpp"

namespace py = pybind11;
using namespace py::literals;

namespace edmill::python {

namespace {

using run::AnyRun;
using run::SeenImpact;

/// Converts numbers of a run to Python: of double to floats, of wider scalars to Decimals.
struct Numbers {
  bool wide;

  py::object of(const std::string& text) const {
    if (wide) return py::module_::import("decimal").attr("Decimal")(text);
    const StandardArithmetic scope;  // Python may ask when the run is over
    return py::float_(std::stod(text));
  }
  py::tuple of(const Vector<std::string>& v) const {
    return py::make_tuple(of(v[0]), of(v[1]), of(v[2]));
  }
  py::tuple of(const BallState<std::string>& s) const {
    return py::make_tuple(of(s.position), of(s.velocity), of(s.spin));
  }
  /// @throws InputError where it is no number. @param what  the function that gave it
  std::string text_of(const py::handle& x, const char* what) const {
    const bool number = PyNumber_Check(x.ptr()) != 0;
    if (number && wide) return py::str(made_by([&] { return PyObject_Str(x.ptr()); }));
    if (number) {
      const double value = call_python([&] { return PyFloat_AsDouble(x.ptr()); });
      if (!PyErr_Occurred()) return to_text<double>(value);
      PyErr_Clear();
    }
    throw InputError(std::string("contact law of the program: ") + what + ": found " +
        std::string(py::str(made_by([&] { return PyObject_Repr(x.ptr()); }))) +
        ", expected a number");
  }
};

/// Calls Python. @return false when Ctrl-C came. @throws py::error_already_set for other exceptions
bool is_done(const auto& work) try {
  work();
  return true;
} catch (const py::error_already_set& error) {
  if (!error.matches(PyExc_KeyboardInterrupt)) throw;
  return false;
}

/// Calls f(name, member) for everything that is known of an impact.
template <class Number, class F> void for_each_member(F&& f) {
  using I = Impact<Number>;
  const auto visit = [&](const auto& self, const char* name, auto member, auto... more) {
    f(name, member);
    if constexpr (sizeof...(more) > 0) self(self, more...);
  };
  visit(visit, "index", &I::index, "time", &I::time, "ball", &I::ball, "with_wall", &I::with_wall,
      "partner", &I::partner, "normal", &I::normal, "approach_speed", &I::approach_speed,
      "slip_speed", &I::slip_speed, "separation_speed", &I::separation_speed,
      "restitution_tangential", &I::restitution_tangential, "normal_impulse", &I::normal_impulse,
      "tangential_impulse", &I::tangential_impulse, "milling_dose", &I::milling_dose,
      "supplied_energy", &I::supplied_energy, "wall_work", &I::wall_work);
}
/// A member of an impact as Python has it.
template <class Value> py::object to_python(const Value& value) {
  if constexpr (std::is_same_v<Value, std::string> || std::is_same_v<Value, Vector<std::string>>)
    return Numbers{true}.of(value);
  else if constexpr (std::is_same_v<Value, Vector<double>>)
    return py::make_tuple(value[0], value[1], value[2]);
  else
    return py::cast(value);
}

template <class Number> void bind_impact(Module& m, const char* name) {
  py::class_<Impact<Number>> impact(m, name);
  for_each_member<Number>([&](const char* member, auto which) {
    impact.def_property_readonly(
        member, [which](const Impact<Number>& i) { return to_python(i.*which); });
  });
}

/// Keeps all impacts; wide ones as a list of tuples, of which the package makes an array.
class Collector : public run::Watcher {
 public:
  explicit Collector(const Numbers& numbers) : numbers_(numbers) {}
  void on_impact(const SeenImpact& impact, AnyRun&) override {
    if (numbers_.wide) {
      texts_.push_back(impact.in_texts());
      return;
    }
    const auto seen = impact.in_double();
    auto& row = doubles_.emplace_back();  // with padding of zeros: equal runs give equal bytes
    for_each_member<double>([&](const char*, auto which) { row.*which = seen.*which; });
  }
  /// Returns the events. In double the array takes over the data of the list without a copy.
  py::object events() {
    if (!numbers_.wide) {
      auto* owner = new std::vector(std::move(doubles_));
      const py::capsule keeper(
          owner, [](void* p) { delete static_cast<std::vector<Impact<double>>*>(p); });
      return py::array_t<Impact<double>>(
          static_cast<py::ssize_t>(owner->size()), owner->data(), keeper);
    }
    py::list rows;
    for (const auto& event : texts_) {
      py::list row;
      for_each_member<std::string>(
          [&](const char*, auto which) { row.append(to_python(event.*which)); });
      rows.append(py::tuple(row));
    }
    return rows;
  }
 private:
  Numbers numbers_;
  std::vector<Impact<double>> doubles_;
  std::vector<Impact<std::string>> texts_;
};

py::list states_of(const AnyRun& run, const Numbers& numbers) {
  py::list rows;
  for (int k = 0; k < run.ball_count(); ++k) rows.append(numbers.of(run.ball(k)));
  return rows;
}

/// The run that an observer of Python is called with.
struct RunOfPython {
  AnyRun& run;
  Numbers numbers;
};

/// Calls the observers after each impact, and ten times a second Python's signal handlers and
/// `progress`; ends the run after Ctrl-C.
class Caller : public run::Watcher {
 public:
  /// @param interrupted  set here, and by laws during which Ctrl-C came
  Caller(const std::vector<py::object>& observers, const py::object& progress,
      const Numbers& numbers, bool& interrupted)
      : observers_(observers), progress_(progress), numbers_(numbers), interrupted_(interrupted) {}

  void on_impact(const SeenImpact& impact, AnyRun& run) override {
    for (const auto& observer : observers_) {
      const Locked python;
      const py::object seen =
          numbers_.wide ? py::cast(impact.in_texts()) : py::cast(impact.in_double());
      if (!is_done([&] { call(observer, seen, RunOfPython{run, numbers_}); })) interrupted_ = true;
    }
    if (!interrupted_) look(impact);
    if (interrupted_) run.stop(model::EndReason::interrupted);
  }
 private:
  using Clock = std::chrono::steady_clock;

  void look(const SeenImpact& impact) {
    if (++since_look_ < (numbers_.wide ? 16 : 1024)) return;
    since_look_ = 0;
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    const Locked python;
    const auto tell = [&] {
      if (!progress_.is_none()) call(progress_, impact.time, impact.index + 1);
    };
    interrupted_ = control_c_came() || !is_done(tell);
  }

  const std::vector<py::object>& observers_;
  const py::object& progress_;
  Numbers numbers_;
  bool& interrupted_;
  Clock::time_point last_ = Clock::now();
  int since_look_ = 0;
};

/// An object with `restitution` and `restitution_of_slip`.
class CallingLaw : public run::LawInTexts {
 public:
  CallingLaw(const py::object& law, const Numbers& numbers, bool& interrupted)
      : restitution_(law.attr("restitution")), of_slip_(law.attr("restitution_of_slip")),
        numbers_(numbers), interrupted_(interrupted) {}
  /// Takes Python's lock, which a run does not hold when it destroys the law.
  ~CallingLaw() override {
    const Locked python;
    restitution_ = py::none();
    of_slip_ = py::none();
  }
  std::string restitution(const std::string& approach_speed) const override {
    const Locked python;
    return ask("restitution", [&] { return call(restitution_, numbers_.of(approach_speed)); });
  }
  std::string restitution_of_slip(const std::string& normal_change, const std::string& slip_speed,
      const std::string& compliance) const override {
    const Locked python;
    return ask("restitution_of_slip", [&] {
      return call(
          of_slip_, numbers_.of(normal_change), numbers_.of(slip_speed), numbers_.of(compliance));
    });
  }
 private:
  /// An impact needs an answer: after Ctrl-C the law is asked again, and the run ends after it.
  template <class Ask> std::string ask(const char* what, const Ask& of_law) const {
    std::string answer;
    const auto answers = [&] { answer = numbers_.text_of(of_law(), what); };
    if (is_done(answers)) return answer;
    interrupted_ = true;
    answers();
    return answer;
  }

  py::object restitution_, of_slip_;
  Numbers numbers_;
  bool& interrupted_;
};

/// @param folder  of the outputs; none when empty
py::dict run_case(const Case& the_case, const std::string& precision, const std::string& folder,
    bool events, bool report, const std::vector<py::object>& observers, const py::object& ball_ball,
    const py::object& ball_wall, const py::object& progress) {
  return casefile::with_memory_for(CaseAccess::spec(the_case), [&] {
    auto spec = CaseAccess::spec(the_case);
    if (report) report::add_report_outputs(spec);
    const Numbers numbers{precision != "double"};
    bool interrupted = false;
    const auto law_of = [&](const py::object& law) {
      return law.is_none() ? nullptr : std::make_shared<CallingLaw>(law, numbers, interrupted);
    };
    run::RunSetup setup;
    setup.ball_ball = law_of(ball_ball);
    setup.ball_wall = law_of(ball_wall);
    Collector collector(numbers);
    Caller caller(observers, progress, numbers, interrupted);
    std::unique_ptr<AnyRun> run;
    {
      const Unlocked others;
      run = run::make_run(precision, spec, setup);
      run->begin();
      if (!folder.empty()) run->write_to(folder);
      if (events) run->attach(collector);
      run->attach(caller);
      run->finish();
      if (!folder.empty())
        run->commit([&] {
          if (report) report::put_report(folder);
          return std::string();
        });
    }
    if (control_c_came()) interrupted = true;  // when the run was already over
    return py::dict("summary"_a = run->summary_json(), "events"_a = collector.events(),
        "states"_a = states_of(*run, numbers), "time"_a = numbers.of(run->time()),
        "interrupted"_a = interrupted);
  });
}

const Binding runs([](Module& m) {
  PYBIND11_NUMPY_DTYPE(Impact<double>, index, time, ball, with_wall, partner, normal,
      approach_speed, slip_speed, separation_speed, restitution_tangential, normal_impulse,
      tangential_impulse, milling_dose, supplied_energy, wall_work);
  PYBIND11_NUMPY_DTYPE(BallState<double>, position, velocity, spin);
  bind_impact<double>(m, "Impact");
  bind_impact<std::string>(m, "WideImpact");
  py::class_<RunOfPython>(m, "Running")
      .def_property_readonly(
          "time", [](const RunOfPython& r) { return r.numbers.of(r.run.time()); })
      .def_property_readonly("ball_count", [](const RunOfPython& r) { return r.run.ball_count(); })
      .def("ball",
          [](const RunOfPython& r, int k) {
            if (k < 0 || k >= r.run.ball_count()) throw py::index_error("no such ball");
            return r.numbers.of(r.run.ball(k));
          })
      .def("stop", [](const RunOfPython& r) { r.run.stop(model::EndReason::stopped); });
  m.attr("event_dtype") = py::dtype::of<Impact<double>>();
  m.attr("state_dtype") = py::dtype::of<BallState<double>>();
  m.attr("precisions") = py::tuple(py::cast(casefile::precisions()));
  m.def("is_precision", &casefile::is_precision);
  m.def("run", &run_case);
});

}  // namespace

}  // namespace edmill::python

PYBIND11_MODULE(_edmill, m) {
  using namespace edmill;
  m.attr("__version__") = version();

  py::register_exception<InputError>(m, "InputError", PyExc_ValueError);
  py::register_exception<UndecidedError>(m, "UndecidedError", PyExc_ArithmeticError);

  py::class_<Case>(m, "Case")
      .def_static("parse", &Case::parse)
      .def_property_readonly("digest", &Case::digest)
      .def_property_readonly("precision", &Case::precision)
      .def_property_readonly("digits", [](const Case& c) { return CaseAccess::spec(c).digits; })
      .def_property_readonly("ball_count", &Case::ball_count)
      .def("text_of",
          [](const Case& c, const std::string& key) {
            return casefile::text_of_key(CaseAccess::spec(c), key);
          })
      .def_property_readonly("balls",
          [](const Case& c) {
            std::vector<std::pair<double, double>> balls;
            for (const auto& ball :
                casefile::build_case<double>(CaseAccess::spec(c)).the_case.balls)
              balls.emplace_back(ball.radius, ball.mass);
            return balls;
          })
      .def_property_readonly("end_time", [](const Case& c) {
        const auto& end = CaseAccess::spec(c).end_time;
        return end ? std::optional<double>(end->to<double>()) : std::nullopt;
      });

  python::Binding::add_all(m);
}
