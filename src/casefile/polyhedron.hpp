// Convex vessels as a case file says them: by planes or by vertices.
#pragma once

#include "casefile/quantity.hpp"
#include "model/vessel.hpp"

namespace edmill::casefile {

class Section;
/// [[vessel.plane]] or [[vessel.vertex]]; what is wrong is reported.
model::Polyhedron<Quantity> read_polyhedron(Section& vessel);

}  // namespace edmill::casefile
