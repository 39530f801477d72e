// The settings that maximise an objective, with their uncertainty.
#pragma once

#include <optional>

#include "study/study.hpp"

namespace edmill::study {

struct Optimum {
  std::optional<std::size_t> best;      ///< index of a point; nothing when no point has a value
  std::vector<std::size_t> contenders;  ///< points that are indistinguishable from the best
  std::string why;                      ///< reason for the end of the search
};

/// Evaluates a grid with a few runs at each point, gives more runs to those that may be the best,
/// and makes the grid finer around the best, until the budget is used.
Optimum optimize(const casefile::OptimizeSpec& spec, Study& study);

/// The longest time that the search will take, in words, from short trials; nothing is written.
std::string forecast(const casefile::OptimizeSpec& spec, Study& study);

/// The result as text.
std::string describe(
    const casefile::OptimizeSpec& spec, const Study& study, const Optimum& optimum);

}  // namespace edmill::study
