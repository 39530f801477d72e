#include "instances/implementations.hpp"

EDMILL_INSTANCES(template, double)

template class edmill::dynamics::WallSearch<edmill::model::SpexMotion<double>,
                                            edmill::model::CylinderVessel<double>>;
