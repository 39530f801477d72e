// collisions.csv: one line for each impact.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "edmill/core/scalar.hpp"
#include "edmill/engine/simulation.hpp"
#include "edmill/record/output_folder.hpp"

namespace edmill::observe {

/// SI; balls and impacts count from 0; every number in as many digits as round-trip in its scalar.
inline constexpr const char* collision_log_header =
    "index,time,ball,partner_kind,partner,approach_speed,slip_speed,milling_dose,wall_work";

template <class Real>
class CollisionLog : public engine::Observer<Real> {
 public:
  /// @param from, until  times [s] that the log is restricted to, both included
  CollisionLog(const std::filesystem::path& place, std::optional<Real> from, std::optional<Real> until)
      : file_(place), from_(from), until_(until) {
    file_.stream() << collision_log_header << '\n';
  }

  void on_impact(const engine::Impact<Real>& impact, engine::Simulation<Real>& simulation) override {
    const Real time = simulation.clock().seconds(impact.time);
    if ((from_ && time < *from_) || (until_ && time > *until_)) return;
    const auto& o = impact.outcome;
    std::string line = std::to_string(impact.index) + "," + to_text<Real>(time) + "," +
                       std::to_string(impact.ball) + (impact.with_wall ? ",wall," : ",ball,") +
                       std::to_string(impact.partner);
    for (const Real* value : {&o.approach_speed, &o.slip_speed, &o.milling_dose, &o.wall_work})
      line += "," + to_text<Real>(*value);
    file_.stream() << line << '\n';
  }

  void commit() { file_.commit(); }

 private:
  record::AtomicFile file_;
  std::optional<Real> from_, until_;
};

}  // namespace edmill::observe
