// The top of the decision ladder, which no run is in.
#include "base/scalar_text.hpp"
#include "base/wide_trigonometry.hpp"
#include "casefile/build_case_impl.hpp"
#include "casefile/quantity_value.hpp"
#include "dynamics/decision_ladder_impl.hpp"
#include "dynamics/wall_search_impl.hpp"

template class edmill::dynamics::WallSearch<edmill::model::AnyMotion<edmill::mpfr50>,
                                            edmill::model::AnyVessel<edmill::mpfr50>>;
template class edmill::dynamics::DecisionLadder<edmill::mpfr50>;
template std::string edmill::to_text<edmill::mpfr50>(const edmill::mpfr50&);
template edmill::mpfr50 edmill::casefile::Quantity::to<edmill::mpfr50>() const;
