// Pictures: snapshot and animation in X3D, frames for ParaView. In double: nothing is computed from them.
#pragma once

#include <unistd.h>

#include <cmath>

#include "edmill/outputs/balls_before.hpp"
#include "edmill/outputs/output.hpp"
#include "edmill/outputs/scene.hpp"

namespace edmill::outputs {

/// Makes scenes of a run.
template <class Real>
class SceneOutput : public Output<Real> {
 public:
  SceneOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
              const RunFacts<Real>& run)
      : Output<Real>(spec, run),
        place_(folder / spec.folder / spec.file),
        contact_(spec.contact_point),
        run_(run) {}

 protected:
  const std::filesystem::path& place() const { return place_; }
  bool shows_contact() const { return contact_.has_value(); }

  static SceneAngles angles(const engine::Simulation<Real>& simulation, double time) {
    const auto& motion = simulation.mill().motion;
    const double phase = static_cast<double>(motion.angular_speed()) * time;
    return {std::acos(0.0) + static_cast<double>(motion.theta_max) * std::cos(phase),
            static_cast<double>(motion.gamma_max) * std::sin(phase)};
  }

  SceneBall contact_at(const Vec3<Real>& point) const {
    return {contact_->radius.template to<double>(), contact_->colour, vector_cast<double>(point)};
  }

  /// @param state_of  state of a ball by its id at `time`
  template <class StateOf>
  Scene scene(const engine::Simulation<Real>& simulation, const Real& time, StateOf&& state_of) const {
    const auto& mill = simulation.mill();
    Scene s{static_cast<double>(mill.motion.arm),
            static_cast<double>(mill.vessel.radius),
            static_cast<double>(mill.vessel.half_height),
            run_.vessel_colour,
            angles(simulation, static_cast<double>(time)),
            {},
            {},
            static_cast<double>(time)};
    for (int i = 0; i < simulation.ball_count(); ++i) {
      const auto state = state_of(i);
      s.balls.push_back({static_cast<double>(simulation.properties(i).radius),
                         run_.ball_colours[static_cast<std::size_t>(i)], vector_cast<double>(state.position),
                         vector_cast<double>(state.velocity), vector_cast<double>(state.spin)});
    }
    return s;
  }

 private:
  std::filesystem::path place_;
  std::optional<casefile::ContactPointSpec> contact_;
  RunFacts<Real> run_;
};

/// The mill at each impact of the record, a file each: NAME_<index>.x3d. (thesis D.4.1)
template <class Real>
class SnapshotOutput : public SceneOutput<Real> {
 public:
  using SceneOutput<Real>::SceneOutput;

  void commit() override {
    for (const auto& [index, text] : pages_) {
      auto place = this->place();
      place.replace_filename(place.stem().string() + "_" + std::to_string(index) +
                             place.extension().string());
      record::AtomicFile file(place);
      file.stream() << text;
      file.commit();
    }
  }

 protected:
  void record(const Seen<Real>& seen) override {
    const BallsBefore<Real> balls(seen);
    const Real& time = seen.facts.time;
    Scene s = this->scene(seen.simulation, time, [&](int i) { return balls.state(i, time); });
    if (this->shows_contact()) s.contact = this->contact_at(seen.facts.contact_point);
    pages_.emplace_back(seen.facts.index, x3d_text(s));
  }

 private:
  std::vector<std::pair<std::uint64_t, std::string>> pages_;
};

/// The record as one X3D page that plays it. (thesis D.4.2) Keys of a ball are its impacts, and frames
/// between them: it flies straight as far as one sees.
template <class Real>
class AnimationOutput : public SceneOutput<Real> {
 public:
  AnimationOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                  const RunFacts<Real>& run)
      : SceneOutput<Real>(spec, folder, run),
        file_(this->place()),
        speed_(spec.animation.speed.to<double>()),
        min_frames_(spec.animation.min_frames),
        frames_(with_frames(spec)) {}

  void commit() override { file_.commit(); }

 protected:
  void before(const Seen<Real>& seen) override {
    if (complete_ || seen.facts.time < this->timer().from()) return;
    const BallsBefore<Real> balls(seen);
    const auto& f = seen.facts;
    const auto sample = [&](const Real& time) {
      add_frame(seen.simulation, time, [&](int i) { return balls.state(i, time); });
    };
    if (paths_.balls.empty()) sample(this->timer().from());
    frames_.pass(this->timer(), f.time, [&](const Real&, const Real& end) { sample(end); });
    complete_ = this->timer().ends_by(f.time);
    const Real last = this->timer().until(f.time);
    if (complete_) sample(last);
    if (last < f.time) return;
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
    const auto state = [&](const Real& time) {
      return
          [&simulation, when = simulation.clock().at(time)](int i) { return simulation.state_at(i, when); };
    };
    const Real& from = this->timer().from();
    if (paths_.balls.empty()) add_frame(simulation, from, state(from));
    if (!complete_) {
      frames_.finish(from, until,
                     [&](const Real&, const Real& end) { add_frame(simulation, end, state(end)); });
    }
    write(simulation, static_cast<double>(from), static_cast<double>(until));
  }

 private:
  static casefile::TimerSpec with_frames(const casefile::OutputSpec& spec) {
    casefile::TimerSpec timer;
    const auto& a = spec.animation;
    timer.interval = casefile::Quantity{a.speed.value * 60 / a.frames_per_minute};
    return timer;
  }

  template <class StateOf>
  void add_frame(const engine::Simulation<Real>& simulation, const Real& time, StateOf&& state_of) {
    if (paths_.balls.empty()) {
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

  record::AtomicFile file_;
  double speed_;
  std::uint64_t min_frames_;
  IntervalClock<Real> frames_;
  bool complete_ = false;
  std::optional<Scene> first_;
  SceneMotion paths_{};
  std::vector<double> times_;
};

/// Frames for ParaView: NAME.pvd, and a folder NAME with balls and vessel of each frame as VTP.
template <class Real>
class ParaviewOutput : public SceneOutput<Real> {
 public:
  ParaviewOutput(const casefile::OutputSpec& spec, const std::filesystem::path& folder,
                 const RunFacts<Real>& run)
      : SceneOutput<Real>(spec, folder, run), index_(this->place()), clock_(spec.timer) {
    frames_place_ = this->place();
    frames_place_.replace_extension();
    partial_ = frames_place_.string() + ".partial-" + std::to_string(::getpid());
    record::prepare_folder(partial_);
  }
  ~ParaviewOutput() override {
    std::error_code ignored;
    std::filesystem::remove_all(partial_, ignored);  // committed frames are no longer there
  }

  void commit() override {
    std::filesystem::remove_all(frames_place_);
    std::filesystem::rename(partial_, frames_place_);
    index_.stream() << pvd_text(list_);
    index_.commit();
  }

 protected:
  void before(const Seen<Real>& seen) override {
    const BallsBefore<Real> balls(seen);
    const auto frame = [&](const Real& time) {
      write_frame(seen.simulation, time, [&](int i) { return balls.state(i, time); });
    };
    if (complete_ || seen.facts.time < this->timer().from()) return;
    if (list_.empty()) frame(this->timer().from());
    clock_.pass(this->timer(), seen.facts.time, [&](const Real&, const Real& end) { frame(end); });
    complete_ = this->timer().ends_by(seen.facts.time);
    if (complete_) frame(this->timer().until(seen.facts.time));
  }
  void record(const Seen<Real>& seen) override {
    const auto& f = seen.facts;
    doses_.resize(static_cast<std::size_t>(f.balls), 0);
    const auto dose = static_cast<double>(f.milling_dose);
    doses_[static_cast<std::size_t>(f.ball)] += dose;
    if (f.ball_ball) doses_[static_cast<std::size_t>(f.partner)] += dose;
  }
  void end_of_record(const engine::Simulation<Real>& simulation, const Real& until) override {
    const auto frame = [&](const Real& time) {
      const auto when = simulation.clock().at(time);
      write_frame(simulation, time, [&](int i) { return simulation.state_at(i, when); });
    };
    if (list_.empty()) frame(this->timer().from());
    if (!complete_)
      clock_.finish(this->timer().from(), until, [&](const Real&, const Real& end) { frame(end); });
  }

 private:
  template <class StateOf>
  void write_frame(const engine::Simulation<Real>& simulation, const Real& time, StateOf&& state_of) {
    Scene s = this->scene(simulation, time, state_of);
    for (std::size_t i = 0; i < doses_.size(); ++i) s.balls[i].milling_dose = doses_[i];
    const std::string number = std::to_string(list_.size()), stem = frames_place_.filename().string();
    list_.push_back({s.time, {}});
    const auto write = [&](const std::string& name, const std::string& text) {
      record::AtomicFile file(partial_ / name);
      file.stream() << text;
      file.commit();
      list_.back().second.push_back(stem + "/" + name);
    };
    write("balls_" + number + ".vtp", vtp_balls(s));
    write("vessel_" + number + ".vtp", vtp_vessel(s));
  }

  record::AtomicFile index_;
  IntervalClock<Real> clock_;
  bool complete_ = false;
  std::filesystem::path frames_place_, partial_;
  std::vector<std::pair<double, std::vector<std::string>>> list_;
  std::vector<double> doses_;
};

}  // namespace edmill::outputs
