#include "instances/implementations.hpp"

EDMILL_GENERAL_SEARCH(template, mpfr)
EDMILL_INSTANCES(template, mpfr)
