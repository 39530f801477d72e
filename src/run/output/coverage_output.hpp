// Where the dose lands, and how often powder is hit: docs/outputs.md, "coverage", "treatment"
#pragma once

#include <algorithm>
#include <array>

#include "base/scalar_list.hpp"
#include "output/table_output.hpp"

namespace edmill::output {

/// Surface area of a ball [m2].
template <class Real> Real ball_area(const Simulation<Real>& simulation, int ball) {
  const Real& radius = simulation.properties(ball).radius;
  return 4 * numerics::pi<Real>() * radius * radius;
}

/// Dose of each ball and each wall: half of the dose of an impact counts for either body.
template <class Real> class BodiesOutput : public TableOutput<Real> {
 public:
  BodiesOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), on_balls_(run.ball_colours.size()),
        on_walls_(run.surfaces(spec).size() + run.bodies.size()) {}
 protected:
  void archive_record(Archive& a) override { a(on_balls_, on_walls_); }

  void record(const ImpactFacts<Real>& f) override {
    const Real half = f.outcome.milling_dose / 2;
    on_balls_[f.impact.ball].add(half);
    (f.impact.with_wall ? on_walls_ : on_balls_)[f.impact.partner].add(half);
  }

  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    this->begin({{"kind", text, "", "ball or wall"}, {"body", integer, "", "its number"},
                    {"impacts", integer, "1", "of the body"},
                    {"dose", number, "J", "half of that of its impacts"},
                    {"dose_rate", number, "W", "the same per second of the record"},
                    {"area", number, "m2", "of its surface"}},
        {this->window(until)});
    const Real time = until - this->timer().from();
    const auto put = [&](const char* kind, std::size_t body, const Tally<Real>& share,
                         const Real& area) {
      const Real dose = share.energy.value();
      this->put(kind, body, share.impacts, dose,
          io::value_if(time > 0, [&] { return Real(dose / time); }), area);
    };
    for (int k = 0; k < simulation.ball_count(); ++k)
      put("ball", k, on_balls_[k], ball_area(simulation, k));
    const auto& walls = this->run.walls;
    for (std::size_t k = 0; k < on_walls_.size(); ++k)
      put("wall", k, on_walls_[k],
          k < walls.size() ? walls[k].area() : this->run.bodies[k - walls.size()].shape.area());
  }
 private:
  std::vector<Tally<Real>> on_balls_, on_walls_;
};

/// Numbers of equal parts into which the coordinates on walls are divided.
struct CoverageKeys {
  std::uint64_t angles = 36, heights = 24, rings = 6, parts = 12;

  static void keys(auto& c, auto&& row) {
    row({"angles", "number of cells around the axis", table_size, "36"}, c.angles);
    row({"heights", "number of cells along the axis", table_size, "24"}, c.heights);
    row({"rings", "number of rings of equal area on round caps", table_size, "6"}, c.rings);
    row({"parts", "number of cells along each edge of a rectangle", table_size, "12"}, c.parts);
  }

  std::size_t parts_of(model::Coordinate c) const {
    return std::array{angles, heights, rings, parts, parts}[static_cast<std::size_t>(c)];
  }
};

/// The walls of a vessel and the parts of its bodies, in columns of equal parts of u and rows of v.
template <class Real> class WallCells {
 public:
  struct Wall {
    model::WallSurface<Real> surface;
    std::size_t columns, rows;
    std::size_t first;  ///< of its cells
    int id, part;       ///< of the wall, and the number of its part if it is a body

    auto cell(std::size_t column, std::size_t row) const { return first + row * columns + column; }
    bool has(model::Coordinate c) const {
      const auto own = surface.coordinates();
      return surface.has_coordinates() && std::find(own.begin(), own.end(), c) != own.end();
    }
    Real area_of_cell() const { return surface.area() / (Real(columns) * Real(rows)); }
  };

  WallCells(const OutputSpec& spec, const RunContext<Real>& run, const CoverageKeys& keys)
      : keys_(keys) {
    int id = 0;
    for (const auto& surface : run.surfaces(spec)) add(surface, id++, 0);
    for (const auto& body : run.bodies) {
      first_part_.push_back(walls_.size());
      int part = 0;
      for (const auto& surface : body.shape.surfaces()) add(surface, id, part++);
      ++id;
    }
  }

  const std::vector<Wall>& walls() const { return walls_; }  ///< and parts of bodies, by id
  std::size_t count() const { return count_; }               ///< of all cells
  /// The cell of the contact point, if what is touched has an area. @pre the impact is with a wall
  std::optional<std::size_t> cell_of(const ImpactFacts<Real>& f) const {
    const auto& mill = f.simulation.mill();
    const int partner = f.impact.partner;
    const auto* body = mill.body_of(partner);
    if (!body)
      return cell_at(walls_[partner],
          mill.motion.position_in_vessel(mill.motion.pose(f.impact.time), f.contact_point));
    const auto pose = body->motion.pose(f.impact.time);
    const auto centre =
        body->motion.position_in_vessel(pose, f.simulation.flight(f.impact.ball).position);
    const auto part = first_part_[partner - mill.vessel.wall_count()] + body->shape.part_at(centre);
    return cell_at(walls_[part], body->motion.position_in_vessel(pose, f.contact_point));
  }
 private:
  void add(const model::WallSurface<Real>& surface, int id, int part) {
    const auto c = surface.coordinates();
    const bool is_body = !first_part_.empty(), empty = is_body && !(surface.area() > 0);
    const auto parts = [&](int axis) -> std::size_t {
      return empty ? 0 : surface.has_coordinates() ? keys_.parts_of(c[axis]) : 1;
    };
    walls_.push_back({surface, parts(0), parts(1), count_, id, part});
    count_ += walls_.back().columns * walls_.back().rows;
  }
  std::optional<std::size_t> cell_at(const Wall& wall, const Vec3<Real>& point) const {
    if (wall.columns == 0) return std::nullopt;
    const auto place = wall.surface.map(point);
    return wall.cell(part(place.u, wall.columns), part(place.v, wall.rows));
  }
  /// The one of `count` equal parts of [0, 1] that has a value; the nearest if rounding moved it
  /// out.
  static std::size_t part(const Real& value, std::size_t count) {
    if (!(value > 0)) return 0;
    const Real place = value * Real(count);
    return place < Real(count) ? static_cast<std::size_t>(place) : count - 1;
  }

  CoverageKeys keys_;
  std::vector<Wall> walls_;
  std::vector<std::size_t> first_part_;  ///< by body: the index in walls_
  std::size_t count_ = 0;
};

/// Dose and impacts by cells of the vessel's walls and the surfaces of bodies.
template <class Real> class CoverageOutput : public TableOutput<Real> {
 public:
  CoverageOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), walls_(spec, run, spec.own_keys<CoverageKeys>()),
        cells_(walls_.count()) {
    const auto& walls = walls_.walls();
    for (std::size_t k = 0; k < model::coordinate_infos.size(); ++k) {
      const auto c = static_cast<model::Coordinate>(k);
      if (std::any_of(walls.begin(), walls.end(), [&](const auto& wall) { return wall.has(c); }))
        coordinates_.push_back(c);
    }
  }
 protected:
  void archive_record(Archive& a) override { a(cells_); }

  void record(const ImpactFacts<Real>& f) override {
    const auto number = f.impact.with_wall ? walls_.cell_of(f) : std::nullopt;
    if (!number) return;
    ++cells_[*number].impacts;
    cells_[*number].dose += f.outcome.milling_dose;
  }

  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    std::vector<Column> columns{{"wall", integer, "", wall_names(simulation.mill().walls())}};
    if (!this->run.bodies.empty())
      columns.push_back({"part", integer, "",
          "of a body: of a box the faces x-, x+, y-, y+, z-, z+ and its rounded edges; of a "
          "cylinder the lower and upper edge, the side, the lower and upper end"});
    for (const auto c : coordinates_) {
      const auto& info = model::info_of(c);
      for (const char* end : {"_low", "_high"})
        columns.push_back(
            {std::string(info.name) + end, number, info.unit, info.meaning + where_none(c)});
    }
    columns.push_back({"area", number, "m2", "area of the cell"});
    columns.push_back({"impacts", integer, "1", "number of impacts"});
    columns.push_back({"dose", number, "J", "milling dose"});
    columns.push_back({"dose_per_area", number, "J/m2", "milling dose of the cell over its area"});
    this->begin(std::move(columns), {this->window(until)});
    for (const auto& wall : walls_.walls())
      for (std::size_t row = 0; row < wall.rows; ++row)
        for (std::size_t column = 0; column < wall.columns; ++column) write_cell(wall, column, row);
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

  void write_cell(const typename WallCells<Real>::Wall& wall, std::size_t column, std::size_t row) {
    this->put(wall.id);
    if (!this->run.bodies.empty()) this->put(wall.part);
    for (const auto c : coordinates_) {
      const bool along_u = wall.surface.coordinates()[0] == c;
      const std::size_t part = along_u ? column : row, parts = along_u ? wall.columns : wall.rows;
      for (const std::size_t edge : {part, part + 1})
        this->put(io::value_if(
            wall.has(c), [&] { return wall.surface.edge(along_u ? 0 : 1, edge, parts); }));
    }
    const Real area = wall.area_of_cell();
    const auto& cell = cells_[wall.cell(column, row)];
    // A wall can have no area, such as the cylinder of a capsule that is as high as wide.
    this->put(area, cell.impacts, cell.dose,
        io::value_if(area > 0, [&] { return Real(cell.dose / area); }));
  }

  WallCells<Real> walls_;
  std::vector<model::Coordinate> coordinates_;  ///< that walls have
  std::vector<Cell> cells_;                     ///< those that at least one wall has
};

struct TreatmentKeys {
  Quantity share, threshold;
  std::uint64_t most = 10;
  CoverageKeys cells;

  static void keys(auto& t, auto&& row) {
    row({"share_per_impact", "fraction of the powder's volume that one impact works",
            Range(1e-12, 1)},
        t.share);
    row({"threshold", Dimension::energy,
            "lowest energy that an impact must dissipate to work powder",
            model::Range::not_negative, "0 J"},
        t.threshold);
    row({"most", "largest number of hits with a row of its own", table_size, "10"}, t.most);
    CoverageKeys::keys(t.cells, row);
  }
};

/// exp(-x) with the same bits on every machine.
template <class Real> Real exp_of_minus(const Real& x) {
  if constexpr (std::is_same_v<Real, double>) {
    return static_cast<double>(exp(-mpfr50(x)));
  } else {
    using std::exp;
    return exp(Real(-x));
  }
}

/// Counts impacts on each ball and each cell of the walls. If powder is mixed between impacts, each
/// impact hits it with the same probability: the number of hits has Poisson's distribution (Delogu
/// and Cocco). If powder stays in place, in an even layer, the mean is that of its own patch.
template <class Real> class TreatmentOutput : public TableOutput<Real> {
 public:
  TreatmentOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : TableOutput<Real>(spec, run), keys_(spec.own_keys<TreatmentKeys>()),
        share_(keys_.share.template to<Real>()), threshold_(keys_.threshold.template to<Real>()),
        walls_(spec, run, keys_.cells), on_walls_(walls_.count()),
        on_balls_(run.ball_colours.size()) {}
 protected:
  void archive_record(Archive& a) override { a(on_walls_, on_balls_, impacts_); }

  void record(const ImpactFacts<Real>& f) override {
    if (f.outcome.milling_dose < threshold_) return;
    ++impacts_;
    ++on_balls_[f.impact.ball];
    if (!f.impact.with_wall)
      ++on_balls_[f.impact.partner];
    else if (const auto cell = walls_.cell_of(f))
      ++on_walls_[*cell];
  }

  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    this->begin(
        {{"hits", text, "",
             "how often powder has been hit; the last row is of all that was hit more often"},
            {"mixed", number, "1", "part of the powder that was, if it is mixed between impacts"},
            {"in_place", number, "1",
                "part of the powder that was, if it stays in an even layer on balls and walls"}},
        {this->window(until), std::to_string(impacts_) + " impacts that work powder"});
    std::vector<Real> mixed(keys_.most + 1), in_place(keys_.most + 1);
    add_poisson(share_ * Real(impacts_), Real(1), mixed);
    Real whole(0);
    for_each_patch(simulation, [&](const Real& area, std::uint64_t) { whole += area; });
    for_each_patch(simulation, [&](const Real& area, std::uint64_t impacts) {
      // Half of the powder that an impact works is on each body.
      const Real layer = area / whole;
      if (layer > 0) add_poisson(share_ / 2 * Real(impacts) / layer, layer, in_place);
    });
    Real more_mixed(1), more_in_place(1);
    for (std::uint64_t hits = 0; hits <= keys_.most; ++hits) {
      this->put(std::to_string(hits), mixed[hits], in_place[hits]);
      more_mixed -= mixed[hits];
      more_in_place -= in_place[hits];
    }
    this->put(
        "more", more_mixed > 0 ? more_mixed : Real(0), more_in_place > 0 ? more_in_place : Real(0));
  }
 private:
  /// Calls f(area [m2], impacts) for each cell of the walls and each ball.
  void for_each_patch(const Simulation<Real>& simulation, auto&& f) const {
    for (const auto& wall : walls_.walls())
      for (std::size_t cell = wall.first; cell < wall.first + wall.columns * wall.rows; ++cell)
        f(wall.area_of_cell(), on_walls_[cell]);
    for (int k = 0; k < simulation.ball_count(); ++k) f(ball_area(simulation, k), on_balls_[k]);
  }

  /// Adds `weight` times Poisson's distribution of this mean.
  void add_poisson(const Real& mean, const Real& weight, std::vector<Real>& sums) const {
    Real probability = exp_of_minus<Real>(mean);
    for (std::uint64_t hits = 0; hits <= keys_.most; ++hits) {
      sums[hits] += weight * probability;
      probability *= mean / Real(hits + 1);
    }
  }

  TreatmentKeys keys_;
  Real share_, threshold_;
  WallCells<Real> walls_;
  std::vector<std::uint64_t> on_walls_, on_balls_;  ///< impacts by cell and by ball
  std::uint64_t impacts_ = 0;
};

}  // namespace edmill::output
