#include "base/wide_trigonometry.hpp"
#include "output/registry.hpp"

template class edmill::output::Outputs<edmill::float128>;
