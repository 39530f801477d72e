#include "instances/instances.hpp"
//
#include "output/outputs_impl.hpp"

EDMILL_OUTPUT_INSTANCES(template, float128)
