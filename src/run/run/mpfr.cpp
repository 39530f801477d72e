#include "run/public_run_impl.hpp"

EDMILL_RUN(edmill::mpfr)
