// Contact laws: constant restitution, Coulomb friction, tables, powder, Hertz's force.
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include "base/elementary.hpp"
#include "model/ball.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

inline constexpr Parameter normal_restitution{
    "restitution", "coefficient of restitution along the normal, e_n", {0, 1}};
inline constexpr Parameter tangential_restitution{
    "restitution_tangential", "tangential coefficient of restitution, e_t", {-1, 1}};

template <class Number> struct ConstantRestitution {
  static constexpr const char* name = "constant";

  Number normal{1};      ///< e_n
  Number tangential{1};  ///< e_t

  static void parameters(auto& law, auto&& visit) {
    visit(normal_restitution, law.normal);
    visit(tangential_restitution, law.tangential);
  }

  const Number& restitution(const Number&) const { return normal; }
  const Number& restitution_of_slip(const auto&...) const { return tangential; }
};

/// The tangential part of laws that define only the normal restitution: e_t = max(beta, 1 - mu c
/// (|g_n| + g_n') / |g_t|). The contact slides throughout, or its slip is reversed by the factor
/// beta. (2.24')
template <class Number> struct CoulombSlip {
  Number friction{0};         ///< mu
  Number min_tangential{-1};  ///< beta, the lowest e_t

  static void parameters(auto& slip, auto&& visit) {
    visit(Parameter{"friction", "coefficient of friction, mu", {0, 1000000}}, slip.friction);
    visit(Parameter{"min_tangential", "smallest tangential coefficient of restitution, e_t",
              {-1, 1}, "-1"},
        slip.min_tangential);
  }

  Number restitution_of_slip(
      const Number& normal_change, const Number& slip, const Number& c) const {
    const Number sliding = friction * c * normal_change;
    // 1 - sliding / slip >= min_tangential, without dividing by a vanishing slip.
    if (sliding >= (1 - min_tangential) * slip) return slip > 0 ? min_tangential : Number(1);
    return 1 - sliding / slip;
  }
};

/// Coulomb friction while sliding, a lowest tangential restitution while sticking. Source: Walton
/// and Braun 1986; Barahona 2011, (2.24), for balls of any mass as in theory.md, section 5.
template <class Number> struct WaltonBraun {
  static constexpr const char* name = "walton-braun";

  Number normal{1};           ///< e_n
  Number friction{0};         ///< mu
  Number min_tangential{-1};  ///< lowest e_t

  static void parameters(auto& law, auto&& visit) {
    visit(normal_restitution, law.normal);
    CoulombSlip<Number>::parameters(law, visit);
  }

  const Number& restitution(const Number&) const { return normal; }
  Number restitution_of_slip(
      const Number& normal_change, const Number& slip, const Number& c) const {
    return CoulombSlip<Number>{friction, min_tangential}.restitution_of_slip(
        normal_change, slip, c);
  }
};

/// Points by ascending argument, and their values.
template <class Number> using LawTable = std::vector<std::array<Number, 2>>;

/// Linear interpolation between the points, constant below the first and above the last one.
/// @pre there are points
template <class Number> Number value_at(const LawTable<Number>& points, const Number& argument) {
  std::size_t k = 0;
  while (k < points.size() && points[k][0] < argument) ++k;
  if (k == 0) return points.front()[1];
  if (k == points.size()) return points.back()[1];
  const auto &low = points[k - 1], &high = points[k];
  const Number share = (argument - low[0]) / (high[0] - low[0]);
  return low[1] * (1 - share) + high[1] * share;
}

/// Normal restitution by approach speed, linear between the points of a table: monotonic where the
/// table is.
template <class Number> struct RestitutionBySpeed : CoulombSlip<Number> {
  static constexpr const char* name = "restitution-by-speed";
  static constexpr Parameter table{"restitution_by_speed", Dimension::none,
      "points of approach speed and e_n, `[[\"0.1 m/s\", 0.9], [\"3 m/s\", "
      "0.6]]`; linear between them, constant beyond"};
  static constexpr Parameter table_rows[] = {
      {"speed", Dimension::speed, "of the approach", Range::not_negative},
      {"restitution", Dimension::none, "e_n of a point", {0, 1}}};
  static constexpr const char* table_form =
      "points [speed, restitution], speeds rising from 0 or more, restitutions from 0 to 1";

  LawTable<Number> points;  ///< approach speed [m/s], rising, and e_n; not empty

  static void parameters(auto& law, auto&& visit) {
    for (auto& point : law.points)
      for (std::size_t k = 0; k < 2; ++k) visit(table_rows[k], point[k]);
    CoulombSlip<Number>::parameters(law, visit);
  }
  void take_shape(const auto& from) { points.resize(from.points.size()); }

  Number restitution(const Number& speed) const { return value_at(points, speed); }
};

/// A constant normal restitution, and a tangential one as a function of slip over approach speed,
/// as for the contacts of DEM codes, which stick for a part of their duration and slip for the rest
/// (docs/dem.md). Beyond the last point a contact slides throughout: its tangential impulse remains
/// that at this point.
template <class Number> struct RestitutionBySlip {
  static constexpr const char* name = "restitution-by-slip";
  static constexpr Parameter table{"tangential_by_slip", Dimension::none,
      "points of the ratio of slip speed to approach speed and e_t, `[[0, -0.4], [3, 0.1]]`; "
      "linear between them, constant below the first, sliding beyond the last"};
  static constexpr Parameter table_rows[] = {
      {"slip", Dimension::none, "over the approach speed", Range::not_negative},
      {"restitution", Dimension::none, "e_t of a point", {-1, 1}}};
  static constexpr const char* table_form =
      "points [slip over approach, e_t], ratios rising from 0 or more, e_t from -1 to 1";

  Number normal{0};
  LawTable<Number> points;  ///< |g_t| / |g_n|, rising, and e_t; not empty

  static void parameters(auto& law, auto&& visit) {
    visit(normal_restitution, law.normal);
    for (auto& point : law.points)
      for (std::size_t k = 0; k < 2; ++k) visit(table_rows[k], point[k]);
  }
  void take_shape(const auto& from) { points.resize(from.points.size()); }

  const Number& restitution(const Number&) const { return normal; }
  Number restitution_of_slip(
      const Number& normal_change, const Number& slip_speed, const Number&) const {
    const auto& last = points.back();
    // The slip over the approach, without a division by an approach of zero.
    const Number slip = slip_speed * (1 + normal);
    if (slip < last[0] * normal_change) return value_at(points, Number(slip / normal_change));
    return slip > 0 ? Number(1 - (1 - last[1]) * last[0] * normal_change / slip) : last[1];
  }
};

/// Balls of steel that are coated with powder, Al-Fe2O3: table 5.3 of Barahona 2011 after Ward et
/// al. 2005. Between its points e_n is linear in the charge ratio and in the diameter, or the mean
/// of two.
template <class Number> struct PowderLoad : CoulombSlip<Number> {
  static constexpr const char* name = "powder-load";
  static constexpr std::array charge_ratios{25, 50, 100};         ///< [1/10]
  static constexpr std::array diameters{2360, 3160, 4760, 9520};  ///< [um]
  static constexpr int percent[3][4] = {{56, 54, 53, 50}, {64, 60, 56, 52}, {80, 74, 64, 55}};

  Number charge_ratio{5};  ///< mass of the balls over that of the powder

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"charge_ratio", "mass of the balls divided by that of the powder",
              Range(2.5, 10), nullptr, "that of the case"},
        law.charge_ratio);
    CoulombSlip<Number>::parameters(law, visit);
  }

  Number restitution(const Number&, const ContactBodies<Number>& bodies) const {
    const Place load = place(charge_ratios, Number(10 * charge_ratio));
    const Place size = place(diameters, Number(1000000 * bodies.mean_diameter()));
    const auto of_row = [&](std::size_t row) {
      const auto& e = percent[row];
      return Number(e[size.below] * (1 - size.share) + e[size.below + 1] * size.share);
    };
    return (of_row(load.below) * (1 - load.share) + of_row(load.below + 1) * load.share) / 100;
  }
 private:
  struct Place {
    std::size_t below;
    Number share;  ///< of the way to the next point, from 0 to 1
  };
  template <std::size_t count>
  static Place place(const std::array<int, count>& points, const Number& x) {
    std::size_t k = 0;
    while (k + 2 < count && x > points[k + 1]) ++k;
    const Number share = (x - points[k]) / (points[k + 1] - points[k]);
    return {k, share < 0 ? Number(0) : share > 1 ? Number(1) : share};
  }
};

inline constexpr Parameter effective_modulus{"effective_modulus", Dimension::pressure,
    "effective modulus E*, with 1/E* = (1 - nu_i^2)/E_i + (1 - nu_j^2)/E_j", Range::positive};

/// Viscoelastic spheres: M x" + k (x^(3/2) + 3/2 A x^(1/2) x') = 0 with k = 4/3 E* R^(1/2), until
/// the force vanishes. e_n depends only on v* = (3/2 A)^(1/2) ((k/M)^2 v)^(1/10). Sources: Ramirez,
/// Poeschel, Brilliantov and Schwager 1999; the rational approximation by Mueller and Poeschel
/// 2011.
template <class Number> struct Viscoelastic : CoulombSlip<Number> {
  static constexpr const char* name = "viscoelastic";

  Number modulus{1};           ///< E* [Pa]
  Number dissipative_time{1};  ///< A [s]

  static void parameters(auto& law, auto&& visit) {
    visit(effective_modulus, law.modulus);
    visit(Parameter{"dissipative_time", Dimension::time, "time A of the dissipative force",
              Range::positive},
        law.dissipative_time);
    CoulombSlip<Number>::parameters(law, visit);
  }

  Number restitution(const Number& approach_speed, const ContactBodies<Number>& bodies) const {
    using std::sqrt;
    const Number by_mass =
        4 * modulus * sqrt(bodies.effective_radius()) / 3 / bodies.effective_mass;
    const Number root = numerics::fifth_root(Number(by_mass * by_mass * approach_speed));
    return by_scaled_speed(Number(sqrt(3 * dissipative_time / 2) * sqrt(root)));
  }
  /// e_n(v*).
  static Number by_scaled_speed(const Number& v) {
    const auto c = [](int millionths) { return Number(millionths) / 1000000; };
    const Number one = 1 + c(501086) * v;
    return one / (one + v * v * (c(1153450) + v * (c(577977) + v * c(532178))));
  }
};

/// Elastic, perfectly plastic: Hertz's force up to a contact pressure, a constant pressure beyond,
/// elastic unloading. e_n is 1 below the yield speed, and falls as v^(-1/4). Source: Thornton 1997,
/// (40) and (33).
template <class Number> struct ElasticPlastic : CoulombSlip<Number> {
  static constexpr const char* name = "elastic-plastic";

  Number modulus{1};         ///< E* [Pa]
  Number yield_pressure{1};  ///< p_y [Pa] at the centre of the contact

  static void parameters(auto& law, auto&& visit) {
    visit(effective_modulus, law.modulus);
    constexpr const char* meaning = "contact pressure at which yielding begins";
    visit(Parameter{"yield_pressure", Dimension::pressure, meaning, Range::positive},
        law.yield_pressure);
    CoulombSlip<Number>::parameters(law, visit);
  }

  /// Yield speed v_y [m/s], at which the energy of the approach raises Hertz's pressure to p_y: M
  /// v_y^2 = 16/15 E* a^5 / R^2, a = pi p_y R / (2 E*).
  Number yield_speed(const ContactBodies<Number>& bodies) const {
    using std::sqrt;
    const Number radius = bodies.effective_radius();
    const Number strain = numerics::pi<Number>() * yield_pressure / (2 * modulus);
    const Number cube = strain * strain * strain, size = radius * radius * radius;
    return sqrt(16 * modulus * (strain * strain * cube * size) / (15 * bodies.effective_mass));
  }
  Number restitution(const Number& approach_speed, const ContactBodies<Number>& bodies) const {
    using std::sqrt;
    const Number yield = yield_speed(bodies);
    if (!(approach_speed > yield)) return Number(1);
    const Number ratio = yield / approach_speed, square = ratio * ratio;
    const Number unloading = ratio / (ratio + 2 * sqrt((6 - square) / 5));
    const Number e = sqrt(6 * sqrt(Number(3)) / 5 * (1 - square / 6) * sqrt(unloading));
    return e < 1 ? e : Number(1);
  }
};

}  // namespace edmill::model
