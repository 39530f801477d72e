// Dose by its place on the vessel. docs/outputs.md, "coverage"
#pragma once

#include <algorithm>

#include "output/table_output.hpp"
#include "output/wall_cells.hpp"

namespace edmill::output {

template <class Real>
class CoverageOutput : public TableOutput<Real> {
 public:
  CoverageOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                 const RunContext<Real>& run)
      : TableOutput<Real>(spec, folder, run),
        walls_(run.surfaces(spec), spec.own_keys<CoverageKeys>()),
        cells_(walls_.count()) {
    for (std::size_t k = 0; k < model::coordinate_infos.size(); ++k) {
      const auto c = static_cast<model::Coordinate>(k);
      const auto& walls = walls_.walls();
      if (std::any_of(walls.begin(), walls.end(), [&](const auto& wall) { return wall.has(c); }))
        coordinates_.push_back(c);
    }
  }

 protected:
  void archive_record(Archive& a) override { a(cells_); }

  void record(const ImpactFacts<Real>& f) override {
    if (!f.impact.with_wall) return;
    auto& cell = cells_[walls_.cell_of(f)];
    ++cell.impacts;
    cell.dose += f.outcome.milling_dose;
  }

  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    using enum Column::Type;
    std::vector<Column> columns{{"wall", integer, "", wall_names(simulation.mill().vessel.walls())}};
    for (const auto c : coordinates_) {
      const auto& info = model::info_of(c);
      for (const char* end : {"_low", "_high"})
        columns.push_back({std::string(info.name) + end, number, info.unit, info.meaning + where_none(c)});
    }
    columns.push_back({"area", number, "m2", "area of the cell"});
    columns.push_back({"impacts", integer, "1", "number of impacts"});
    columns.push_back({"dose", number, "J", "milling dose"});
    columns.push_back({"dose_per_area", number, "J/m2", "milling dose of the cell over its area"});
    this->begin(std::move(columns), {this->window(until)});
    const auto& walls = walls_.walls();
    for (std::size_t wall = 0; wall < walls.size(); ++wall)
      for (std::size_t row = 0; row < walls[wall].rows; ++row)
        for (std::size_t column = 0; column < walls[wall].columns; ++column) write_cell(wall, column, row);
  }

 private:
  struct Cell {
    std::uint64_t impacts = 0;
    Real dose{0};  ///< [J]
    void archive(Archive& a) { a(impacts, dose); }
  };
  /// "0 the cap at -y, 1 the cap at +y"
  static std::string wall_names(const std::vector<model::WallInfo>& walls) {
    std::string text;
    for (std::size_t wall = 0; wall < walls.size(); ++wall)
      text += (wall == 0 ? "" : ", ") + std::to_string(wall) + " " + walls[wall].meaning;
    return text;
  }
  /// "; none on caps"
  std::string where_none(model::Coordinate c) const {
    std::string text;
    for (const auto& wall : walls_.walls()) {
      const std::string name = wall.surface.name();
      if (!wall.has(c) && text.find(name) == std::string::npos)
        text += (text.empty() ? "; none on " : ", ") + name;
    }
    return text;
  }

  void write_cell(std::size_t index, std::size_t column, std::size_t row) {
    const auto& wall = walls_.walls()[index];
    this->put(static_cast<std::uint64_t>(index));
    for (const auto c : coordinates_) {
      const bool along_u = wall.surface.coordinates()[0] == c;
      const std::size_t part = along_u ? column : row, parts = along_u ? wall.columns : wall.rows;
      for (const std::size_t edge : {part, part + 1})
        this->put(io::value_if(wall.has(c), [&] { return wall.surface.edge(along_u ? 0 : 1, edge, parts); }));
    }
    const Real area = wall.area_of_cell();
    const auto& cell = cells_[wall.cell(column, row)];
    // Walls of no area are those of a vessel that is just round.
    this->put(area, cell.impacts, cell.dose, io::value_if(area > 0, [&] { return Real(cell.dose / area); }));
  }

  WallCells<Real> walls_;
  std::vector<model::Coordinate> coordinates_;  ///< that walls have
  std::vector<Cell> cells_;                     ///< wall after wall, row after row
};

}  // namespace edmill::output
