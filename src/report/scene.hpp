// An X3D page of a run as part of an HTML page: for X3DOM, and as a still drawing.
#pragma once

#include <filesystem>
#include <pugixml.hpp>

namespace edmill::report {

/// The page that an `animation` wrote. @throws InputError when it is not one
pugi::xml_document read_animation(const std::filesystem::path& file);

/// Adds <x3d> with the scene: without its background, and with numbers and key frames that suffice for the
/// eye.
/// @param most_keys  of all moving things together
void add_scene(pugi::xml_node parent, const pugi::xml_document& animation, std::size_t most_keys);

/// Adds an <svg> of the scene's first frame, seen along the Z axis.
void add_still(pugi::xml_node parent, const pugi::xml_document& animation);

}  // namespace edmill::report
