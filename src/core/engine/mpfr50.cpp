// The top of the decision ladder, which no run is in.
#include "engine/instances.hpp"

EDMILL_LADDER(template, edmill::mpfr50)
