// Restitution of balls that are coated with powder, by the load.
#pragma once

#include <array>

#include "model/laws/coulomb_slip.hpp"
#include "model/parts/contact_bodies.hpp"

namespace edmill::model {

/// Table 5.3 of Barahona 2011 after Ward et al. 2005: balls of steel with Al-Fe2O3. Between its points e_n
/// is linear in the charge ratio and in the diameter; balls of two diameters count with the mean of both.
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
    visit(Parameter{"charge_ratio", Dimension::none, "mass of the balls over that of the powder",
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

}  // namespace edmill::model
