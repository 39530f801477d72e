#include "instances/tools/implementations.hpp"

EDMILL_TOOL_INSTANCES(template, mpfr)
