// Restitution by approach speed, as a table gives it.
#pragma once

#include "model/laws/coulomb_slip.hpp"
#include "model/laws/table.hpp"

namespace edmill::model {

/// Straight lines between the points of the table, constant below the first and above the last one: what
/// grows or falls in the table does so between its points, and another code has the same law in three lines.
template <class Number>
struct RestitutionBySpeed : CoulombSlip<Number> {
  static constexpr const char* name = "restitution-by-speed";
  static constexpr const char* table = "restitution_by_speed";
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

}  // namespace edmill::model
