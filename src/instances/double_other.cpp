#include "dynamics/wall_search_impl.hpp"
#include "instances/instances.hpp"

EDMILL_GENERAL_SEARCH(template, double)

template class edmill::dynamics::WallSearch<edmill::model::ChainMotion<double>,
                                            edmill::model::CylinderVessel<double>>;
