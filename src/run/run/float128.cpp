#include "run/run_of.hpp"

EDMILL_RUN(edmill::float128)
