// Tabulated restitution: by approach speed, by slip, or by the load of powder.
#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "model/ball.hpp"
#include "model/laws/walton_braun.hpp"

namespace edmill::model {

/// Points by ascending argument, and their values.
template <class Number>
using LawTable = std::vector<std::array<Number, 2>>;

/// Linear interpolation between the points, constant below the first and above the last one.
/// @pre there are points
template <class Number>
Number value_at(const LawTable<Number>& points, const Number& argument) {
  std::size_t k = 0;
  while (k < points.size() && points[k][0] < argument) ++k;
  if (k == 0) return points.front()[1];
  if (k == points.size()) return points.back()[1];
  const auto &low = points[k - 1], &high = points[k];
  const Number share = (argument - low[0]) / (high[0] - low[0]);
  return low[1] * (1 - share) + high[1] * share;
}

/// Normal restitution by approach speed, linear between the points of a table. The interpolation is monotonic
/// where the table is, and takes three lines in another code.
template <class Number>
struct RestitutionBySpeed : CoulombSlip<Number> {
  static constexpr const char* name = "restitution-by-speed";
  static constexpr Parameter table{"restitution_by_speed", Dimension::none,
                                   "points of approach speed and e_n, `[[\"0.1 m/s\", 0.9], [\"3 m/s\", "
                                   "0.6]]`; linear between them, constant beyond"};
  static constexpr Parameter table_rows[] = {
      {"speed", Dimension::speed, "of the approach", Range::not_negative},
      {"restitution", Dimension::none, "e_n of a point", {0, 1}}};
  static constexpr const char* table_form =
      "points [speed, restitution], speeds rising from 0 or more, restitutions from 0 to 1";

  LawTable<Number> points;  ///< approach speed [m/s], rising, and e_n

  static void parameters(auto& law, auto&& visit) {
    for (auto& point : law.points)
      for (std::size_t k = 0; k < 2; ++k) visit(table_rows[k], point[k]);
    CoulombSlip<Number>::parameters(law, visit);
  }
  void take_shape(const auto& from) { points.resize(from.points.size()); }

  /// @pre there are points
  Number restitution(const Number& approach_speed) const { return value_at(points, approach_speed); }
};

/// A constant normal restitution, and a tangential one as a function of slip over approach speed. This
/// describes the contacts of DEM codes, which stick for a part of their duration and slip for the rest
/// (docs/dem.md). Beyond the last point a contact slides throughout: its tangential impulse remains that at
/// this point.
template <class Number>
struct RestitutionBySlip {
  static constexpr const char* name = "restitution-by-slip";
  static constexpr Parameter table{
      "tangential_by_slip", Dimension::none,
      "points of the ratio of slip speed to approach speed and e_t, `[[0, -0.4], [3, 0.1]]`; linear between "
      "them, constant below the first, sliding beyond the last"};
  static constexpr Parameter table_rows[] = {
      {"slip", Dimension::none, "over the approach speed", Range::not_negative},
      {"restitution", Dimension::none, "e_t of a point", {-1, 1}}};
  static constexpr const char* table_form =
      "points [slip over approach, e_t], ratios rising from 0 or more, e_t from -1 to 1";

  Number normal{0};
  LawTable<Number> points;  ///< |g_t| / |g_n|, rising, and e_t

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"restitution", "coefficient of restitution along the normal, e_n", {0, 1}}, law.normal);
    for (auto& point : law.points)
      for (std::size_t k = 0; k < 2; ++k) visit(table_rows[k], point[k]);
  }
  void take_shape(const auto& from) { points.resize(from.points.size()); }

  const Number& restitution(const Number&) const { return normal; }
  /// @pre there are points
  Number restitution_of_slip(const Number& normal_change, const Number& slip_speed, const Number&) const {
    const auto& last = points.back();
    // The slip over the approach, without a division by an approach of zero.
    const Number slip = slip_speed * (1 + normal);
    if (!(slip < last[0] * normal_change)) {
      if (!(slip > 0)) return last[1];
      return 1 - (1 - last[1]) * last[0] * normal_change / slip;
    }
    return value_at(points, Number(slip / normal_change));
  }
};

/// Balls that are coated with powder: table 5.3 of Barahona 2011 after Ward et al. 2005, balls of steel with
/// Al-Fe2O3. Between its points e_n is linear in the charge ratio and in the diameter; balls of two diameters
/// count with the mean of both.
template <class Number>
struct PowderLoad : CoulombSlip<Number> {
  static constexpr const char* name = "powder-load";
  static constexpr std::array<int, 3> charge_ratios{25, 50, 100};                ///< [1/10]
  static constexpr std::array<int, 4> diameters{2360, 3160, 4760, 9520};         ///< [um]
  static constexpr std::array<std::array<int, 4>, 3> percent{{{56, 54, 53, 50},  //
                                                              {64, 60, 56, 52},
                                                              {80, 74, 64, 55}}};

  Number charge_ratio{5};  ///< mass of the balls over that of the powder

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"charge_ratio", "mass of the balls divided by that of the powder", Range(2.5, 10),
                    nullptr, "that of the case"},
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

}  // namespace edmill::model
