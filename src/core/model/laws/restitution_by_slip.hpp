// Tangential restitution by slip over approach, as a table gives it: so are the contacts of DEM codes, which
// stick for a part of their duration and slip for the rest. docs/dem.md
#pragma once

#include "model/laws/table.hpp"
#include "model/parts/parameter.hpp"

namespace edmill::model {

/// One normal restitution; e_t by straight lines between the points of the table, constant below the first.
/// Beyond the last one a contact slides throughout: its tangential impulse stays that of the last point.
template <class Number>
struct RestitutionBySlip {
  static constexpr const char* name = "restitution-by-slip";
  static constexpr const char* table = "tangential_by_slip";
  static constexpr Parameter table_rows[] = {
      {"slip", Dimension::none, "over the approach speed", Range::not_negative},
      {"restitution", Dimension::none, "e_t of a point", {-1, 1}}};
  static constexpr const char* table_form =
      "points [slip over approach, e_t], ratios rising from 0 or more, e_t from -1 to 1";

  Number normal{0};
  LawTable<Number> points;  ///< |g_t| / |g_n|, rising, and e_t

  static void parameters(auto& law, auto&& visit) {
    visit(Parameter{"restitution", Dimension::none, "e_n", {0, 1}}, law.normal);
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

}  // namespace edmill::model
