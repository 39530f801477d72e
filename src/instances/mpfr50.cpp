// The top of the decision ladder, which no run is in.
#include "base/scalar_text.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case_impl.hpp"
#include "casefile/quantity_value.hpp"
#include "dynamics/decision_ladder_impl.hpp"
#include "dynamics/wall_search_impl.hpp"

namespace edmill {

template class dynamics::WallSearch<model::AnyMotion<mpfr50>, model::AnyVessel<mpfr50>>;
template class dynamics::DecisionLadder<mpfr50>;
template std::string to_text<mpfr50>(const mpfr50&);
template mpfr50 casefile::Quantity::to<mpfr50>() const;

}  // namespace edmill
