#include "base/scalar_text.hpp"
#include "base/wide_trigonometry.hpp"

#define EDMILL_TEXT(Real)                                  \
  template std::string edmill::to_text<Real>(const Real&); \
  template Real edmill::from_text<Real>(const std::string&);
EDMILL_FOR_EACH_SCALAR(EDMILL_TEXT)
template std::string edmill::to_text<edmill::mpfr50>(const edmill::mpfr50&);
