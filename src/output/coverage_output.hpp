// Dose by its place on the vessel. docs/outputs.md, "coverage"
#pragma once

#include "base/trigonometry.hpp"
#include "casefile/output_columns.hpp"
#include "output/sectors.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

/// How the vessel's walls are cut into cells.
struct CoverageKeys {
  std::uint64_t angles, heights, rings;
};

inline void read_coverage(casefile::Section& s, const casefile::CaseSpec&, casefile::OutputSpec& output) {
  using casefile::read_size;
  output.own =
      CoverageKeys{read_size(s, "angles", 36), read_size(s, "heights", 24), read_size(s, "rings", 6)};
}

template <class Real>
class CoverageOutput : public TableOutput<Real> {
 public:
  CoverageOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                 const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        heights_(spec.own_keys<CoverageKeys>().heights),
        rings_(spec.own_keys<CoverageKeys>().rings),
        sectors_(spec.own_keys<CoverageKeys>().angles),
        cells_((2 * rings_ + heights_) * sectors_.count()) {}

 protected:
  void archive_record(Archive& a) override { a(cells_); }

  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    if (f.ball_ball) return;
    const Vec3<Real> p = own_contact_point(seen, pose_of(seen));
    const auto& vessel = *seen.simulation.mill().vessel.template get_if<model::CylinderVessel<Real>>();
    const bool cylinder = f.partner == 2;
    // Rings have equal areas: equal parts of the squared radius.
    const Real part = cylinder ? Real((p[1] / vessel.half_height + 1) / 2)
                               : Real((p[0] * p[0] + p[2] * p[2]) / (vessel.radius * vessel.radius));
    auto& cell =
        cells_[cell_of(f.partner, band(part, cylinder ? heights_ : rings_), sectors_.holding(p[0], p[2]))];
    ++cell.impacts;
    cell.dose += f.milling_dose;
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    using enum Column::Type;
    const char *const angle = "about the vessel's axis from x, the arm, to z",
                      *const height = "along y from the vessel's centre; none on caps",
                      *const radius = "from the vessel's axis; none on the cylinder";
    this->begin({{"wall", integer, "", "0 the cap at -y, 1 the cap at +y, 2 the cylinder"},
                 {"angle_low", number, "rad", angle},
                 {"angle_high", number, "rad", angle},
                 {"height_low", number, "m", height},
                 {"height_high", number, "m", height},
                 {"radius_low", number, "m", radius},
                 {"radius_high", number, "m", radius},
                 {"area", number, "m2", "area of the cell"},
                 {"impacts", integer, "1", "number of impacts"},
                 {"dose", number, "J", "milling dose"},
                 {"dose_per_area", number, "J/m2", "milling dose of the cell over its area"}},
                {this->window(until)});
    for (int wall = 0; wall < model::wall_count; ++wall)
      for (std::size_t b = 0; b < (wall == 2 ? heights_ : rings_); ++b)
        for (std::size_t a = 0; a < sectors_.count(); ++a)
          write_cell(*simulation.mill().vessel.template get_if<model::CylinderVessel<Real>>(), wall, b, a);
  }

 private:
  struct Cell {
    std::uint64_t impacts = 0;
    Real dose{0};  ///< [J]
    void archive(Archive& a) { a(impacts, dose); }
  };

  /// Which of `count` equal parts of [0, 1] holds a value; rounding may have put it outside.
  static std::size_t band(const Real& value, std::size_t count) {
    if (!(value > 0)) return 0;
    const Real place = value * Real(count);
    return place < Real(count) ? static_cast<std::size_t>(place) : count - 1;
  }
  std::size_t cell_of(int wall, std::size_t band, std::size_t sector) const {
    return (static_cast<std::size_t>(wall) * rings_ + band) * sectors_.count() + sector;
  }

  void write_cell(const model::CylinderVessel<Real>& vessel, int wall, std::size_t band, std::size_t sector) {
    using std::sqrt;
    const Real turn = 2 * numerics::pi<Real>(), angles = Real(sectors_.count());
    const std::optional<Real> none;
    this->put(wall, Real(turn * Real(sector) / angles), Real(turn * Real(sector + 1) / angles));
    Real area;
    if (wall == 2) {
      for (const std::size_t edge : {band, band + 1})
        this->put(Real(vessel.half_height * (2 * Real(edge) / Real(heights_) - 1)));
      this->put(none, none);
      area = turn * vessel.radius * 2 * vessel.half_height / (angles * Real(heights_));
    } else {
      this->put(none, none);
      for (const std::size_t edge : {band, band + 1})
        this->put(Real(vessel.radius * sqrt(Real(edge) / Real(rings_))));
      area = turn / 2 * (vessel.radius * vessel.radius) / (angles * Real(rings_));
    }
    const auto& cell = cells_[cell_of(wall, band, sector)];
    this->put(area, cell.impacts, cell.dose, Real(cell.dose / area));
  }

  std::size_t heights_, rings_;
  Sectors<Real> sectors_;
  std::vector<Cell> cells_;  ///< cap 0, cap 1, cylinder; band after band
};

}  // namespace edmill::output
