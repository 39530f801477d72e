#include "instances/implementations.hpp"

EDMILL_GENERAL_SEARCH(template, mpfr50)
EDMILL_INSTANCES(template, mpfr50)
