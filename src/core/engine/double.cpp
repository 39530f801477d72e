#include "engine/instances.hpp"

template class edmill::engine::Simulation<double>;
template class edmill::dynamics::DecisionLadder<double>;
template class edmill::dynamics::WallSearch<edmill::model::SpexMotion<double>,
    edmill::model::CylinderVessel<double>>;
