#include "run/instances.hpp"

EDMILL_RUN(double)
