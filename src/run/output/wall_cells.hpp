// The walls of a vessel in cells of equal area.
#pragma once

#include <algorithm>
#include <vector>

#include "casefile/output_entry.hpp"
#include "output/output.hpp"

namespace edmill::output {

/// Into how many equal parts the coordinates on walls are divided.
struct CoverageKeys {
  std::uint64_t angles = 36, heights = 24, rings = 6, parts = 12;

  static void keys(auto& c, auto&& row) {
    using casefile::table_size;
    row(casefile::Parameter{"angles", Dimension::none, "cells about the axis", table_size, "36"}, c.angles);
    row(casefile::Parameter{"heights", Dimension::none, "cells along the axis", table_size, "24"}, c.heights);
    row(casefile::Parameter{"rings", Dimension::none, "of equal area on round caps", table_size, "6"},
        c.rings);
    row(casefile::Parameter{"parts", Dimension::none, "along each edge of a rectangle", table_size, "12"},
        c.parts);
  }

  std::size_t parts_of(model::Coordinate c) const {
    switch (c) {
      case model::Coordinate::angle:
        return angles;
      case model::Coordinate::height:
        return heights;
      case model::Coordinate::radius:
        return rings;
      default:
        return parts;
    }
  }
};

/// The walls of a vessel, each in columns of equal parts of u and rows of equal parts of v.
template <class Real>
class WallCells {
 public:
  struct Wall {
    model::WallSurface<Real> surface;
    std::size_t columns, rows;
    std::size_t first;  ///< of its cells

    std::size_t cell(std::size_t column, std::size_t row) const { return first + row * columns + column; }
    bool has(model::Coordinate c) const {
      const auto own = surface.coordinates();
      return std::find(own.begin(), own.end(), c) != own.end();
    }
    Real area_of_cell() const { return surface.area() / (Real(columns) * Real(rows)); }
  };

  WallCells(const std::vector<model::WallSurface<Real>>& surfaces, const CoverageKeys& keys) {
    for (const auto& surface : surfaces) {
      const auto c = surface.coordinates();
      walls_.push_back({surface, keys.parts_of(c[0]), keys.parts_of(c[1]), count_});
      count_ += walls_.back().columns * walls_.back().rows;
    }
  }

  const std::vector<Wall>& walls() const { return walls_; }  ///< by id
  std::size_t count() const { return count_; }               ///< of all cells
  /// The cell of the contact point. @pre the impact is with a wall
  std::size_t cell_of(const ImpactFacts<Real>& f) const {
    const auto& wall = walls_[static_cast<std::size_t>(f.impact.partner)];
    const auto place = wall.surface.map(own_contact_point(f, pose_of(f)));
    return wall.cell(part(place.u, wall.columns), part(place.v, wall.rows));
  }

 private:
  /// Which of `count` equal parts of [0, 1] holds a value; rounding may have put it outside.
  static std::size_t part(const Real& value, std::size_t count) {
    if (!(value > 0)) return 0;
    const Real place = value * Real(count);
    return place < Real(count) ? static_cast<std::size_t>(place) : count - 1;
  }

  std::vector<Wall> walls_;
  std::size_t count_ = 0;
};

}  // namespace edmill::output
