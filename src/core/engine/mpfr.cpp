#include "engine/instances.hpp"

EDMILL_LADDER(template, edmill::mpfr)
template class edmill::engine::Simulation<edmill::mpfr>;
