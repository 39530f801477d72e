// Moving pictures: animation in X3D, frames for ParaView. In double: nothing is computed from them.
#pragma once

#include <functional>

#include "io/atomic_folder.hpp"
#include "output/scene_outputs.hpp"

namespace edmill::output {

/// A frame at the start of the record, at the end of each interval, and at the end of the record.
template <class Real>
class FramesOutput : public SceneOutput<Real> {
 public:
  /// @param interval  its `interval` and `max_rows` are those of the frames
  FramesOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
               const RunFacts<Real>& run, const casefile::TimerSpec& interval)
      : SceneOutput<Real>(spec, folder, run), clock_(interval) {}

 protected:
  using StateOf = std::function<model::BallState<Real>(int ball)>;  ///< at the time of the frame
  virtual void add_frame(const engine::Simulation<Real>& simulation, const Real& time,
                         const StateOf& state_of) = 0;

  void before(const Seen<Real>& seen) override {
    const Real& now = seen.facts.time;
    if (complete_ || now < this->timer().from()) return;
    const BallsBefore<Real> balls(seen);
    const auto frame = [&](const Real& time) {
      add_frame(seen.simulation, time, [&](int i) { return balls.state(i, time); });
    };
    if (!begun_) frame(this->timer().from());
    begun_ = true;
    clock_.pass(this->timer(), now, [&](const Real&, const Real& end) { frame(end); });
    complete_ = this->timer().ends_by(now);
    if (complete_) frame(this->timer().until(now));
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const auto frame = [&](const Real& time) {
      const auto when = simulation.instant_of(time);
      add_frame(simulation, time, [&](int i) { return simulation.state_at(i, when); });
    };
    const Real& from = this->timer().from();
    if (!begun_) frame(from);
    if (!complete_) clock_.finish(from, until, [&](const Real&, const Real& end) { frame(end); });
  }
  void archive_record(Archive& a) override { a(clock_, begun_, complete_); }

 private:
  IntervalClock<Real> clock_;
  bool begun_ = false, complete_ = false;
};

/// The record as one X3D page that plays it. (thesis D.4.2) Keys of a ball are its impacts, and frames
/// between them: it flies straight as far as one sees.
template <class Real>
class AnimationOutput : public FramesOutput<Real> {
 public:
  AnimationOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                  const RunFacts<Real>& run)
      : FramesOutput<Real>(spec, folder, run, frames_of(spec.animation)),
        file_(this->place()),
        speed_(spec.animation.speed.to<double>()),
        min_frames_(spec.animation.min_frames) {}

  void commit() override { file_.commit(); }

 protected:
  void before(const Seen<Real>& seen) override {
    FramesOutput<Real>::before(seen);
    const auto& f = seen.facts;
    if (f.time < this->timer().from() || this->timer().until(f.time) < f.time) return;
    for (const int ball : {f.ball, f.ball_ball ? f.partner : f.ball})
      add_key(ball, f.time, seen.simulation.flight(ball).position);
  }
  void record(const Seen<Real>& seen) override {
    if (!this->shows_contact()) return;
    const auto key = static_cast<double>(seen.facts.time);
    const SceneBall contact = this->contact_at(seen.facts.contact_point);
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
    a(file_, first_, paths_, times_);
  }

 private:
  static casefile::TimerSpec frames_of(const casefile::AnimationSpec& a) {
    casefile::TimerSpec timer;
    timer.interval = casefile::Quantity{a.speed.value * 60 / a.frames_per_minute};
    return timer;
  }

  void add_frame(const engine::Simulation<Real>& simulation, const Real& time,
                 const typename FramesOutput<Real>::StateOf& state_of) override {
    if (!first_) {
      first_ = this->scene(simulation, time, state_of);
      paths_.balls.resize(first_->balls.size());
    }
    for (int i = 0; i < simulation.ball_count(); ++i) add_key(i, time, state_of(i).position);
    times_.push_back(static_cast<double>(time));
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
    if (times_.size() < min_frames_ + 1) {
      times_.clear();
      for (std::uint64_t k = 0; k <= min_frames_; ++k)
        times_.push_back(from + length * static_cast<double>(k) / static_cast<double>(min_frames_));
    }
    for (const double time : times_)
      paths_.vessel.emplace_back((time - from) / length, this->angles(simulation, time));
    paths_.duration = length / speed_;
    file_.stream() << x3d_text(*first_, &paths_);
  }

  io::AtomicFile file_;
  double speed_;
  std::uint64_t min_frames_;
  std::optional<Scene> first_;
  SceneMotion paths_{};
  std::vector<double> times_;
};

/// Frames for ParaView: NAME.pvd, and a folder NAME with balls and vessel of each frame as VTP.
template <class Real>
class ParaviewOutput : public FramesOutput<Real> {
 public:
  ParaviewOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                 const RunFacts<Real>& run)
      : FramesOutput<Real>(spec, folder, run, spec.timer),
        index_(this->place()),
        frames_(std::filesystem::path(this->place()).replace_extension()) {}

  void commit() override {
    frames_.commit();
    index_.stream() << pvd_text(list_);
    index_.commit();
  }

 protected:
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    doses_.resize(static_cast<std::size_t>(f.balls), 0);
    const auto dose = static_cast<double>(f.milling_dose);
    doses_[static_cast<std::size_t>(f.ball)] += dose;
    if (f.ball_ball) doses_[static_cast<std::size_t>(f.partner)] += dose;
  }
  void archive_record(Archive& a) override {
    FramesOutput<Real>::archive_record(a);
    a(index_, frames_, list_, doses_);
  }

 private:
  void add_frame(const engine::Simulation<Real>& simulation, const Real& time,
                 const typename FramesOutput<Real>::StateOf& state_of) override {
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
