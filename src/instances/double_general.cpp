#include "dynamics/wall_search_impl.hpp"
#include "instances/instances.hpp"

EDMILL_GENERAL_SEARCH(template, double)
