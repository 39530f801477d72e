// Robust least squares of the rows of a log.
#pragma once

#include <vector>

#include "identify/parameters.hpp"
#include "identify/residuals.hpp"

namespace edmill::identify {

/// Parameters that are fitted together, on top of assumptions that hold already.
struct Model {
  Assumptions base;
  std::vector<const Parameter*> free;

  Assumptions with(const std::vector<double>& values) const;
};

struct Fit {
  std::vector<double> values,
      half_widths;  ///< SI; the intervals hold 99.7 % of normal noise, and a common shift
  double cost = 0;  ///< `misfit` of the rows
};

/// 2 sum ln(1 + (r/s)^2) + 2 n ln s over the rows, with the median of |r| of each kind as s: minus twice the
/// log of Cauchy's likelihood. Wild rows count little, and rows that fit by orders of magnitude better count
/// much.
double misfit(const std::vector<double>& rows, const std::vector<RowKind>& kinds);

/// Least squares by Eigen's Levenberg and Marquardt (that of MINPACK), repeated with Cauchy weights whose
/// scale shrinks from the misfits of the start down to the tolerance, so that rows with other causes lose
/// their say.
/// @param start  values to begin with
Fit fit(const Residuals& residuals, const Model& model, std::vector<double> start);

/// Derivatives of the rows by each parameter, at the base; empty for one that the rows do not depend on.
std::vector<std::vector<double>> slopes_of(const Residuals& residuals, const Assumptions& base,
                                           const std::vector<Parameter>& parameters);

/// The change of the parameters that explains the rows best if they are linear in them, in units of
/// `columns`.
/// @param columns  derivative of the rows by each parameter
/// @return the misfit that is left
double linear_misfit(const std::vector<double>& rows, const std::vector<RowKind>& kinds,
                     const std::vector<const std::vector<double>*>& columns, std::vector<double>& change);

}  // namespace edmill::identify
