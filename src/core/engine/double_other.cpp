// Separate from double.cpp, because next to these searches that of the SPEX would be inlined less.
#include "engine/instances.hpp"

EDMILL_GENERAL_SEARCH(template, double)

template class edmill::dynamics::WallSearch<edmill::model::ChainMotion<double>,
    edmill::model::CylinderVessel<double>>;
