// The record as one X3D page that plays it. (thesis D.4.2)
#pragma once

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "casefile/output_entry.hpp"
#include "output/scene_output.hpp"

namespace edmill::output {

struct AnimationKeys {
  static void keys(auto& output, auto&& row) {
    row(casefile::contact_point_key, output.contact_point);
    casefile::AnimationSpec::keys(output.animation, row);
  }
};

/// Keys of a ball are its impacts, and frames between them: it flies straight as far as one sees.
template <class Real>
class AnimationOutput : public FramesOutput<Real> {
 public:
  AnimationOutput(const casefile::OutputSpec& spec, const RunContext<Real>& run)
      : FramesOutput<Real>(spec, run, frames_of(spec.animation)) {}

 protected:
  void before(const ImpactFacts<Real>& f) override {
    FramesOutput<Real>::before(f);
    if (f.time < this->timer().from() || this->timer().until(f.time) < f.time) return;
    for (const int ball : {f.impact.ball, f.impact.with_wall ? f.impact.ball : f.impact.partner})
      add_key(ball, f.time, f.simulation.flight(ball).position);
  }
  void record(const ImpactFacts<Real>& f) override {
    if (!this->spec.contact_point) return;
    const auto key = static_cast<double>(f.time);
    const SceneBall contact = this->contact_at(f.contact_point);
    // It stays where it was up to this impact, then jumps.
    if (!first_->contact) first_->contact = contact;
    paths_.contact.emplace_back(key,
                                paths_.contact.empty() ? contact.position : paths_.contact.back().second);
    paths_.contact.emplace_back(key, contact.position);
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    FramesOutput<Real>::end_of_record(simulation, until);
    write(simulation, static_cast<double>(this->timer().from()), static_cast<double>(until));
  }
  void archive_record(Archive& a) override {
    FramesOutput<Real>::archive_record(a);
    a(first_, paths_, frames_);
    const auto balls = this->run.ball_colours.size();
    if (first_ ? first_->balls.size() != balls || paths_.balls.size() != balls : !paths_.balls.empty())
      throw InputError("found a saved animation of other balls");
  }

 private:
  static casefile::TimerSpec frames_of(const casefile::AnimationSpec& a) {
    casefile::TimerSpec timer;
    timer.interval =
        a.speed * casefile::Quantity{60} / casefile::Quantity(static_cast<std::int64_t>(a.frames_per_minute));
    return timer;
  }

  void add_frame(const Moment<Real>& at) override {
    if (!first_) {
      first_ = this->scene(at);
      paths_.balls.resize(first_->balls.size());
    }
    for (int i = 0; i < at.simulation.ball_count(); ++i) add_key(i, at.time, at.state_of(i).position);
    ++frames_;
  }
  void add_key(int ball, const Real& time, const Vec3<Real>& place) {
    paths_.balls[static_cast<std::size_t>(ball)].emplace_back(static_cast<double>(time),
                                                              vector_cast<double>(place));
  }

  void write(const engine::Simulation<Real>& simulation, double from, double until) {
    const double length = until > from ? until - from : 1;
    const auto to_fractions = [&](SceneMotion::Path& path) {
      for (auto& [key, place] : path) key = (key - from) / length;
    };
    for (auto& path : paths_.balls) to_fractions(path);
    to_fractions(paths_.contact);
    const auto& motion = simulation.mill().motion;
    const auto& vessel = simulation.mill().vessel;
    // As many keys of the vessel as frames, and enough for turns of the drive or a piston between them.
    double frequency = 1 / static_cast<double>(motion.period());
    if (const auto* pistons = vessel.pistons())
      for (const auto& piston : pistons->given())
        for (const auto& swing : piston.swings)
          frequency = std::max(frequency, std::abs(static_cast<double>(swing.frequency)));
    const double turns = length * frequency;
    const auto keys = std::max(
        {this->spec.animation.min_frames, frames_ - 1, static_cast<std::uint64_t>(std::ceil(64 * turns))});
    std::vector<Vec3<double>> at_first;  // the pistons
    for (std::uint64_t k = 0; k <= keys; ++k) {
      const double key = static_cast<double>(k) / static_cast<double>(keys);
      paths_.vessel.emplace_back(key, vessel_frame(motion, from + length * key));
      std::size_t piston = 0;
      this->for_each_piston(vessel, Real(from + length * key), [&](std::size_t wall, const auto& moved) {
        if (k == 0) {
          paths_.pistons.push_back({wall, {}});
          at_first.push_back(moved);
        }
        paths_.pistons[piston].second.emplace_back(key, moved - at_first[piston]);
        ++piston;
      });
    }
    std::vector<Frame<double>> frames;
    for (const auto& [key, frame] : paths_.vessel) frames.push_back(frame);
    look_at(this->walls(), frames, *first_);
    paths_.duration = length / this->spec.animation.speed.template to<double>();
    this->file_.stream() << x3d_text(*first_, &paths_);
  }

  std::optional<Scene> first_;
  SceneMotion paths_{};
  std::uint64_t frames_ = 0;
};

}  // namespace edmill::output
