// Contact laws: the separation speed of two bodies after an impact, and the part of their slip that
// remains. (2.23'), (2.24')
#pragma once

#include <memory>
#include <utility>
#include <variant>

#include "base/scalar.hpp"
#include "edmill/contact_law.hpp"
#include "edmill/errors.hpp"
#include "model/laws/laws.hpp"

namespace edmill::model {

/// The laws that a case file can name, the default first. A new law is a file in model/laws/ and a
/// line here: its parameters are read, described and passed to every scalar by its list of them.
template <class Number>
using NamedLaws = std::variant<WaltonBraun<Number>,  //
    ConstantRestitution<Number>,                     //
    RestitutionBySpeed<Number>,                      //
    RestitutionBySlip<Number>,                       //
    Viscoelastic<Number>,                            //
    ElasticPlastic<Number>,                          //
    PowderLoad<Number>>;

/// A law defined by a program. It has no name in case files. Converted to another scalar it is
/// empty: the ladder uses wider scalars only for searches, which need no law.
template <class Real> struct LawOfProgram {
  static constexpr const char* name = "custom";

  std::shared_ptr<const edmill::CustomLaw<Real>> law;

  static void parameters(auto&, auto&&) {}

  /// @throws InputError unless the program's answer is in [0, 1]
  Real restitution(const Real& approach_speed) const {
    const Real e = law->restitution(approach_speed);
    if (!(e >= 0 && e <= 1))
      throw InputError("contact law of the program: restitution(" + to_text<Real>(approach_speed) +
          "): found " + to_text<Real>(e) + ", expected 0 to 1");
    return e;
  }
  /// Values a little below -1 are allowed, since measured contacts may reverse more than the slip;
  /// whether the impact gains energy by that is checked when all of it is known.
  /// @throws InputError unless the program's answer is in [-1.5, 1]
  Real restitution_of_slip(
      const Real& normal_change, const Real& slip_speed, const Real& compliance) const {
    const Real e = law->restitution_of_slip(normal_change, slip_speed, compliance);
    if (!(e >= -1.5 && e <= 1))
      throw InputError("contact law of the program: restitution_of_slip(" +
          to_text<Real>(normal_change) + ", " + to_text<Real>(slip_speed) + ", " +
          to_text<Real>(compliance) + "): found " + to_text<Real>(e) + ", expected -1.5 to 1");
    return e;
  }
};

/// e_n of one law, which may or may not depend on the bodies.
template <class Law, class Number>
Number restitution_of(
    const Law& law, const Number& approach_speed, const ContactBodies<Number>& bodies) {
  if constexpr (requires { law.restitution(approach_speed, bodies); })
    return law.restitution(approach_speed, bodies);
  else
    return law.restitution(approach_speed);
}

namespace detail {
template <class Law, class... Others>
std::variant<Others..., Law> with(const std::variant<Others...>&);
}  // namespace detail

/// @tparam Number  the scalar of a run, or the exact quantity of a case file
template <class Number> struct ContactLaw {
  decltype(detail::with<LawOfProgram<Number>>(std::declval<NamedLaws<Number>>())) law;
  Number least_separation{
      0};  ///< v_s [m/s]: bodies leave an impact no slower; theory.md, section 6

  const char* name() const {
    return std::visit([](const auto& l) { return l.name; }, law);
  }
  /// Calls visit(Parameter, value) for every parameter of the law.
  void parameters(auto&& visit) const {
    std::visit([&](const auto& l) { l.parameters(l, visit); }, law);
  }

  /// e_n in [0, 1]. @param approach_speed  |g_n| >= 0 [m/s]
  /// @param bodies  the two bodies of the impact
  Number restitution(const Number& approach_speed, const ContactBodies<Number>& bodies) const {
    return std::visit(
        [&](const auto& l) { return Number(restitution_of(l, approach_speed, bodies)); }, law);
  }

  /// Speed at which the contact points leave each other along the normal, max(e_n |g_n|, v_s)
  /// [m/s]. (2.23')
  Number separation_speed(const Number& approach_speed, const ContactBodies<Number>& bodies) const {
    const Number by_restitution = restitution(approach_speed, bodies) * approach_speed;
    return by_restitution < least_separation ? least_separation : by_restitution;
  }

  /// e_t, the part of the slip that an impact leaves, in [-1, 1]. (2.24')
  /// @param normal_change  |g_n| + g_n' >= 0 [m/s]: the normal impulse over the effective mass
  /// @param slip_speed     |g_t| >= 0 [m/s]
  /// @param compliance     1 + M/(m_i J_i) + M/(m_j J_j), for a wall 1 + 1/J_i; makes the
  /// tangential impulse
  ///                       exactly mu times the normal impulse while sliding (theory.md, section 5)
  Number restitution_of_slip(
      const Number& normal_change, const Number& slip_speed, const Number& compliance) const {
    return std::visit(
        [&](const auto& l) {
          return Number(l.restitution_of_slip(normal_change, slip_speed, compliance));
        },
        law);
  }
};

/// The law with each of its numbers converted.
template <class To, class From, class Convert>
ContactLaw<To> convert_law(const ContactLaw<From>& from, const Convert& convert) {
  ContactLaw<To> to;
  std::visit([&]<template <class> class Law>(
                 const Law<From>& law) { to.law = converted<Law, To>(law, convert); },
      from.law);
  to.least_separation = convert(from.least_separation);
  return to;
}

}  // namespace edmill::model
