#include "engine/instances.hpp"

EDMILL_LADDER(template, edmill::float128)
template class edmill::engine::Simulation<edmill::float128>;
