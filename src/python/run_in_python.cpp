#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <chrono>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "api/case_access.hpp"
#include "api/run_access.hpp"
#include "base/with_scalar.hpp"
#include "casefile/memory_for.hpp"
#include "casefile/precisions.hpp"
#include "casefile/right_digits.hpp"
#include "edmill/run.hpp"
#include "instances/instances.hpp"
#include "python/binding.hpp"
#include "report/report_page.hpp"
#include "report/run_folder.hpp"

namespace py = pybind11;

namespace edmill::python {

namespace {

/// A float, or a Decimal with all digits of a wider scalar.
template <class Real>
py::object to_python(const Real& x) {
  if constexpr (std::is_same_v<Real, double>)
    return py::float_(x);
  else
    return py::module_::import("decimal").attr("Decimal")(to_text<Real>(x));
}
template <class Real>
py::tuple to_python(const Vector<Real>& v) {
  return py::make_tuple(to_python<Real>(v[0]), to_python<Real>(v[1]), to_python<Real>(v[2]));
}
/// @throws InputError where it is no number. @param what  the function that gave it
template <class Real>
Real from_python(const py::handle& x, const char* what) {
  if (PyNumber_Check(x.ptr()) != 0) {
    if constexpr (std::is_same_v<Real, double>) {
      const double value = call_python([&] { return PyFloat_AsDouble(x.ptr()); });
      if (!PyErr_Occurred()) return value;
      PyErr_Clear();
    } else {
      try {
        return from_text<Real>(py::str(made_by([&] { return PyObject_Str(x.ptr()); })));
      } catch (const std::exception&) {  // told below
      }
    }
  }
  throw InputError(std::string("contact law of the program: ") + what + ": found " +
                   std::string(py::str(made_by([&] { return PyObject_Repr(x.ptr()); }))) +
                   ", expected a number");
}

/// Ctrl-C while Python code runs in a callback.
bool is_control_c(const py::error_already_set& error) { return error.matches(PyExc_KeyboardInterrupt); }

/// Calls f(name, member) for everything that is known of an impact.
template <class Real, class F>
void for_each_member(F&& f) {
  using I = Impact<Real>;
  f("index", &I::index), f("time", &I::time), f("ball", &I::ball), f("with_wall", &I::with_wall);
  f("partner", &I::partner), f("normal", &I::normal), f("approach_speed", &I::approach_speed);
  f("slip_speed", &I::slip_speed), f("separation_speed", &I::separation_speed);
  f("restitution_tangential", &I::restitution_tangential), f("normal_impulse", &I::normal_impulse);
  f("tangential_impulse", &I::tangential_impulse), f("milling_dose", &I::milling_dose);
  f("supplied_energy", &I::supplied_energy), f("wall_work", &I::wall_work);
}
template <class Real>
py::object member(const Impact<Real>& impact, const auto& which) {
  const auto& value = impact.*which;
  if constexpr (std::is_integral_v<std::decay_t<decltype(value)>>)
    return py::cast(value);
  else
    return to_python<Real>(value);
}

/// The array owns what the list held: nothing is copied.
template <class Row>
py::array as_array(std::vector<Row> rows) {
  auto owner = std::make_unique<std::vector<Row>>(std::move(rows));
  const auto size = static_cast<py::ssize_t>(owner->size());
  const Row* data = owner->data();
  py::capsule keeper(owner.release(), [](void* p) { delete static_cast<std::vector<Row>*>(p); });
  return py::array_t<Row>(size, data, keeper);
}
/// Wide numbers are objects, a list of tuples for the package to make an array of.
template <class Real>
py::object events_of(std::vector<Impact<Real>> events) {
  if constexpr (std::is_same_v<Real, double>) {
    return as_array(std::move(events));
  } else {
    py::list rows;
    for (const auto& event : events) {
      py::list row;
      for_each_member<Real>([&](const char*, const auto& which) { row.append(member<Real>(event, which)); });
      rows.append(py::tuple(row));
    }
    return rows;
  }
}
template <class Real>
py::object states_of(const Run<Real>& run) {
  std::vector<BallState<Real>> states;
  for (int k = 0; k < run.ball_count(); ++k) states.push_back(run.ball(k));
  if constexpr (std::is_same_v<Real, double>) {
    return as_array(std::move(states));
  } else {
    py::list rows;
    for (const auto& s : states)
      rows.append(
          py::make_tuple(to_python<Real>(s.position), to_python<Real>(s.velocity), to_python<Real>(s.spin)));
    return rows;
  }
}

template <class Real>
class Collector : public Observer<Real> {
 public:
  void on_impact(const Impact<Real>& impact, Run<Real>&) override { events.push_back(impact); }
  std::vector<Impact<Real>> events;
};

/// Lets Python's signal handlers run and tells of progress, ten times a second; ends the run after Ctrl-C.
template <class Real>
class Pulse : public Observer<Real> {
 public:
  /// @param interrupted  set here, and by callbacks during which Ctrl-C came
  Pulse(py::object progress, bool& interrupted) : interrupted_(interrupted), progress_(std::move(progress)) {}

  void on_impact(const Impact<Real>& impact, Run<Real>& run) override {
    if (interrupted_) return run.interrupt();
    if (++since_look_ < look_every_) return;
    since_look_ = 0;
    const auto now = Clock::now();
    if (now - last_ < std::chrono::milliseconds(100)) return;
    last_ = now;
    const Locked python;
    if (call_python(PyErr_CheckSignals) != 0) {
      PyErr_Clear();
      interrupted_ = true;
      run.interrupt();
    } else if (!progress_.is_none()) {
      try {
        call(progress_, static_cast<double>(impact.time), impact.index + 1);
      } catch (const py::error_already_set& error) {
        if (!is_control_c(error)) throw;
        interrupted_ = true;
        run.interrupt();
      }
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr int look_every_ = std::is_same_v<Real, double> ? 1024 : 16;
  bool& interrupted_;
  py::object progress_;
  Clock::time_point last_ = Clock::now();
  int since_look_ = 0;
};

/// A callable that receives each impact and the run.
template <class Real>
class CallingObserver : public Observer<Real> {
 public:
  CallingObserver(py::object callable, bool& interrupted)
      : callable_(std::move(callable)), interrupted_(interrupted) {}
  void on_impact(const Impact<Real>& impact, Run<Real>& run) override {
    const Locked python;
    try {
      call(callable_, impact, py::cast(&run, py::return_value_policy::reference));
    } catch (const py::error_already_set& error) {
      if (!is_control_c(error)) throw;
      interrupted_ = true;
      run.interrupt();
    }
  }

 private:
  py::object callable_;
  bool& interrupted_;
};

/// An object with `restitution` and `restitution_of_slip`.
template <class Real>
class CallingLaw : public CustomLaw<Real> {
 public:
  CallingLaw(const py::object& law, bool& interrupted)
      : restitution_(law.attr("restitution")),
        of_slip_(law.attr("restitution_of_slip")),
        interrupted_(interrupted) {}
  /// A run may let go of it without Python's lock.
  ~CallingLaw() override {
    const Locked python;
    restitution_ = py::none();
    of_slip_ = py::none();
  }
  Real restitution(const Real& approach_speed) const override {
    const Locked python;
    return ask("restitution", [&] { return call(restitution_, to_python<Real>(approach_speed)); });
  }
  Real restitution_of_slip(const Real& normal_change, const Real& slip_speed,
                           const Real& compliance) const override {
    const Locked python;
    return ask("restitution_of_slip", [&] {
      return call(of_slip_, to_python<Real>(normal_change), to_python<Real>(slip_speed),
                  to_python<Real>(compliance));
    });
  }

 private:
  /// An impact needs an answer: after Ctrl-C the law is asked again, and the run ends after the impact.
  template <class Ask>
  Real ask(const char* what, const Ask& of_law) const {
    try {
      return from_python<Real>(of_law(), what);
    } catch (const py::error_already_set& error) {
      if (!is_control_c(error)) throw;
      interrupted_ = true;
    }
    return from_python<Real>(of_law(), what);
  }

  py::object restitution_, of_slip_;
  bool& interrupted_;
};

template <class Real>
std::shared_ptr<const CustomLaw<Real>> law_of(const py::object& law, bool& interrupted) {
  if (law.is_none()) return nullptr;
  return std::make_shared<CallingLaw<Real>>(law, interrupted);
}

struct Wishes {
  std::string folder;  ///< of the outputs; none when empty
  bool events, report;
  std::vector<py::object> observers;
  py::object ball_ball, ball_wall, progress;
};

template <class Real>
py::dict run_in(Case the_case, const Wishes& wishes) {
  if (wishes.report) {
    auto spec = CaseAccess::spec(the_case);
    report::add_report_outputs(spec);
    the_case = CaseAccess::make(std::move(spec));
  }
  bool interrupted = false;
  const Laws<Real> laws{law_of<Real>(wishes.ball_ball, interrupted),
                        law_of<Real>(wishes.ball_wall, interrupted)};
  Collector<Real> collector;
  Pulse<Real> pulse(wishes.progress, interrupted);
  std::vector<std::unique_ptr<CallingObserver<Real>>> callables;
  for (const auto& o : wishes.observers)
    callables.push_back(std::make_unique<CallingObserver<Real>>(o, interrupted));

  std::unique_ptr<Run<Real>> run;
  {
    const Unlocked others;
    run = std::make_unique<Run<Real>>(the_case, laws);
    if (!wishes.folder.empty()) run->write_to(wishes.folder);
    if (wishes.events) run->attach(collector);
    for (auto& callable : callables) run->attach(*callable);
    run->attach(pulse);
    run->finish();
    if (!wishes.folder.empty())
      RunAccess::commit<Real>(*run, [&] {
        if (wishes.report) report::put_report(wishes.folder);
      });
  }
  if (PyErr_CheckSignals() != 0) {  // Ctrl-C when the run was already over
    PyErr_Clear();
    interrupted = true;
  }
  py::dict result;
  result["summary"] = run->summary().json;
  result["events"] = events_of<Real>(std::move(collector.events));
  result["states"] = states_of<Real>(*run);
  result["time"] = to_python<Real>(run->time());
  result["interrupted"] = interrupted;
  return result;
}

template <class Real>
void add_scalar(Module& m, const std::string& name) {
  auto impact = py::class_<Impact<Real>>(m, ("Impact_" + name).c_str());
  for_each_member<Real>([&](const char* title, const auto& which) {
    impact.def_property_readonly(title, [which](const Impact<Real>& i) { return member<Real>(i, which); });
  });
  py::class_<Run<Real>>(m, ("Run_" + name).c_str())
      .def_property_readonly("time", [](const Run<Real>& run) { return to_python<Real>(run.time()); })
      .def_property_readonly("ball_count", &Run<Real>::ball_count)
      .def("ball",
           [](const Run<Real>& run, int k) {
             if (k < 0 || k >= run.ball_count()) throw py::index_error("no such ball");
             const auto s = run.ball(k);
             return py::make_tuple(to_python<Real>(s.position), to_python<Real>(s.velocity),
                                   to_python<Real>(s.spin));
           })
      .def("stop", &Run<Real>::stop);
}

py::dict run(const Case& the_case, const std::string& precision, const std::string& folder, bool events,
             bool report, const std::vector<py::object>& observers, const py::object& ball_ball,
             const py::object& ball_wall, const py::object& progress) {
  const Wishes wishes{folder, events, report, observers, ball_ball, ball_wall, progress};
  return with_scalar(precision, [&]<class Real>() {
    const auto& spec = CaseAccess::spec(the_case);
    const auto shown = casefile::only_right_digits<Real>(spec);
    return casefile::with_memory_for(spec, [&] { return run_in<Real>(the_case, wishes); });
  });
}

const Binding runs([](Module& m) {
  PYBIND11_NUMPY_DTYPE(Impact<double>, index, time, ball, with_wall, partner, normal, approach_speed,
                       slip_speed, separation_speed, restitution_tangential, normal_impulse,
                       tangential_impulse, milling_dose, supplied_energy, wall_work);
  PYBIND11_NUMPY_DTYPE(BallState<double>, position, velocity, spin);
#define EDMILL_ADD(Real) add_scalar<Real>(m, std::string(ScalarName<Real>::value));
  EDMILL_FOR_EACH_SCALAR(EDMILL_ADD)
#undef EDMILL_ADD
  m.attr("event_dtype") = py::dtype::of<Impact<double>>();
  m.attr("state_dtype") = py::dtype::of<BallState<double>>();
  m.attr("precisions") = py::tuple(py::cast(casefile::precisions()));
  m.def("is_precision", &casefile::is_precision);
  m.def("run", &run);
});

}  // namespace

}  // namespace edmill::python
