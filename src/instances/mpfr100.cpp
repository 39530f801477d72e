#include "instances/implementations.hpp"

EDMILL_GENERAL_SEARCH(template, mpfr100)
EDMILL_INSTANCES(template, mpfr100)
