#include "instances/implementations.hpp"

EDMILL_GENERAL_SEARCH(template, float128)
EDMILL_INSTANCES(template, float128)
