// Frames for ParaView: NAME.pvd, and a folder NAME with balls and vessel of each frame as VTP.
#pragma once

#include "casefile/output_entry.hpp"
#include "io/atomic_file.hpp"
#include "output/scene_output.hpp"

namespace edmill::output {

struct ParaviewKeys {
  static void keys(auto& output, auto&& row) {
    row(casefile::interval_key("10 ms"), output.timer.interval);
    row(casefile::max_rows_key(), output.timer.max_rows);
  }
};

template <class Real>
class ParaviewOutput : public FramesOutput<Real> {
 public:
  ParaviewOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : FramesOutput<Real>(spec, run, spec.timer),
        index_(this->place()),
        frames_(std::filesystem::path(this->place()).replace_extension()) {}

  void complete() override {
    index_.stream() << pvd_text(list_);
    index_.complete();
  }
  void commit() override {
    frames_.commit();
    index_.commit();
  }
  std::vector<std::filesystem::path> places() const override {
    auto places = frames_.places();
    for (auto& place : index_.places()) places.push_back(std::move(place));
    return places;
  }

 protected:
  void record(const ImpactFacts<Real>& f) override {
    doses_.resize(static_cast<std::size_t>(f.simulation.ball_count()), 0);
    const auto dose = static_cast<double>(f.outcome.milling_dose);
    doses_[static_cast<std::size_t>(f.impact.ball)] += dose;
    if (!f.impact.with_wall) doses_[static_cast<std::size_t>(f.impact.partner)] += dose;
  }
  void archive_record(Archive& a) override {
    FramesOutput<Real>::archive_record(a);
    a(index_, frames_, list_, doses_);
  }

 private:
  void add_frame(const engine::Simulation<Real>& simulation, const Real& time,
                 const StateOf<Real>& state_of) override {
    Scene s = this->scene(simulation, time, state_of);
    for (std::size_t i = 0; i < doses_.size(); ++i) s.balls[i].milling_dose = doses_[i];
    const std::string number = std::to_string(list_.size());
    list_.push_back({s.time, {}});
    const auto write = [&](const std::string& name, const std::string& text) {
      frames_.add(name, text);
      list_.back().second.push_back(frames_.place().filename().string() + "/" + name);
    };
    write("balls_" + number + ".vtp", vtp_balls(s));
    write("vessel_" + number + ".vtp", vtp_vessel(s));
  }

  io::AtomicFile index_;
  io::AtomicFolder frames_;
  std::vector<std::pair<double, std::vector<std::string>>> list_;
  std::vector<double> doses_;
};

}  // namespace edmill::output
