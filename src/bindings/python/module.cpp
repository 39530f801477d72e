// The extension module edmill._edmill: cases, runs, studies and judges of the library as plain Python values.
// The package edmill (src/python/edmill) is what users import.
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "edmill/case.hpp"
#include "edmill/errors.hpp"
#include "python/binding.hpp"
#include "run/case_access.hpp"

namespace py = pybind11;

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
      .def("text_of", [](const Case& c,
                         const std::string& key) { return casefile::text_of_key(CaseAccess::spec(c), key); })
      .def_property_readonly(
          "balls",
          [](const Case& c) {
            std::vector<std::pair<double, double>> balls;
            for (const auto& ball : casefile::build_case<double>(CaseAccess::spec(c)).the_case.balls)
              balls.emplace_back(ball.radius, ball.mass);
            return balls;
          })
      .def_property_readonly("end_time", [](const Case& c) {
        const auto& end = CaseAccess::spec(c).end_time;
        return end ? std::optional<double>(end->to<double>()) : std::nullopt;
      });

  python::Binding::add_all(m);
}
