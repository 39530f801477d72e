#include "implementations.hpp"

EDMILL_INSTANCES(template, double)
