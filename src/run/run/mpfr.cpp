#include "run/instances.hpp"

EDMILL_RUN(edmill::mpfr)
