#include "base/wide_trigonometry.hpp"
#include "output/outputs_impl.hpp"

template class edmill::output::Outputs<edmill::mpfr>;
