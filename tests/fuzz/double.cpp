// What the readers need in double.
#include "base/scalar_text.hpp"
#include "casefile/build_case_impl.hpp"

namespace edmill {
template std::string to_text<double>(const double&);
template double from_text<double>(const std::string&);
template double casefile::Quantity::to<double>() const;
template model::Mill<double> casefile::build_mill<double>(const casefile::CaseSpec&);
template casefile::InitialCase<double> casefile::build_case_in<double>(
    const model::Mill<double>&, const casefile::CaseSpec&, bool);
}  // namespace edmill
