#include "instances/implementations.hpp"

EDMILL_INSTANCES(template, double)
