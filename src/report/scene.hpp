// An animation as part of an HTML page: the frames that its player shows, and a still drawing.
#pragma once

#include <pugixml.hpp>

#include "report/animation.hpp"

namespace edmill::report {

/// Adds <script type="application/json" id="frames">, which page.js plays. Lengths in millimetres:
///   {duration, eye, target,
///    vessel: {radius, height, colour, opacity, poses: [x, y, z, qx, qy, qz, qw of each frame]},
///    spheres: {radii, colours, places: [x, y, z of each sphere, frame by frame]}}
/// Frames divide the playback into equal parts, from its beginning to its end.
void add_frames(pugi::xml_node parent, const Animation& animation);

/// Adds an <svg> of the first frame, seen along the Z axis.
void add_still(pugi::xml_node parent, const Animation& animation);

}  // namespace edmill::report
