// Walls as triangles, for codes that support no other walls.
#pragma once

#include <array>
#include <span>
#include <string>
#include <vector>

#include "model/bodies/rounded_body.hpp"
#include "model/motion.hpp"
#include "model/vessel.hpp"

namespace edmill::decks {

using Triangle = std::array<Vec3<double>, 3>;

/// The triangles of one part of the vessel, and the angle beyond which an edge is one.
struct WallMesh {
  std::string name;
  std::vector<Triangle> triangles;
  double smooth_angle = 0;  ///< [deg] of facets that represent a round wall; 0 for flat walls
};

/// A round wall becomes a prism around it, whose facets touch it along their middles, one of them on the
/// vessel's x axis. Empty for a vessel that has none.
std::vector<WallMesh> meshes_of(const model::AnyVessel<double>& vessel, int facets);

/// The surface of a body, whose round parts are prisms within it.
WallMesh mesh_of(const model::RoundedBody<double>& body, const std::string& name);

/// Unit normal, out of the vessel, of the facet of that prism that is nearest to a position.
Vec3<double> facet_normal(const model::Tube<double>& tube, int facets, const Vec3<double>& place);

/// The text of an STL file (ASCII) of these meshes, placed as in this pose.
std::string stl_text(std::span<const WallMesh> meshes, const model::AnyMotion<double>& motion,
                     const model::AnyPose<double>& pose);

}  // namespace edmill::decks
