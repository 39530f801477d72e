// The top of the decision ladder; no run uses this scalar.
#include "engine/instances.hpp"

EDMILL_LADDER(template, edmill::mpfr50)
