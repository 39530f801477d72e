#include "edmill/instances.hpp"
//
#include "edmill/outputs/outputs_impl.hpp"

EDMILL_OUTPUT_INSTANCES(template, mpfr50)
