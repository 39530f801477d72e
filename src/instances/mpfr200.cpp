#include "instances/implementations.hpp"

EDMILL_GENERAL_SEARCH(template, mpfr200)
EDMILL_INSTANCES(template, mpfr200)
