#include "run/instances.hpp"

EDMILL_RUN(edmill::float128)
