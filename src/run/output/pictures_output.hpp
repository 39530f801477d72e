// Pictures of the mill. In double: nothing is computed from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <list>

#include "base/errors.hpp"
#include "io/atomic_file.hpp"
#include "output/output.hpp"
#include "output/scene.hpp"

namespace edmill::output {

/// Makes scenes of a run.
template <class Real> class SceneOutput : public Output<Real> {
 public:
  SceneOutput(const OutputSpec& spec, const RunContext<Real>& run) : Output<Real>(spec, run) {
    for (const auto& surface : run.surfaces(spec)) walls_.push_back(model::mesh_of(surface));
  }
 protected:
  /// A mark at a contact point, with the radius and colour given in the case.
  SceneBall contact_at(const Vec3<Real>& point) const {
    const auto& mark = *this->spec.contact_point;
    return {mark.radius.template to<double>(), mark.colour, vector_cast<double>(point)};
  }

  /// The walls at their places, without the displacement of pistons.
  const std::vector<model::Mesh>& walls() const { return walls_; }

  /// Calls f(wall, moved) with the displacement of each piston from its wall's place [m].
  static void for_each_piston(const model::AnyVessel<Real>& vessel, const Real& time, auto&& f) {
    const auto* pistons = vessel.pistons();
    for (std::size_t k = 0; pistons && k < pistons->count(); ++k) {
      const int wall = pistons->wall(k);
      const Vec3<Real> normal = vessel.normal(wall, Vec3<Real>::Zero());
      f(wall, vector_cast<double>(Vec3<Real>(normal * pistons->at(k, {0, time}).value)));
    }
  }

  /// The scene at a moment, without a viewpoint, which `look_at` sets.
  Scene scene(const Moment<Real>& at) const {
    const auto& mill = at.simulation.mill();
    const auto now = static_cast<double>(at.time);
    Scene s{.vessel = {walls_, this->run.vessel_colour, frame_of(mill.motion, now)}, .time = now};
    for (std::size_t k = 0; k < mill.bodies.size(); ++k)
      s.bodies.push_back({{model::mesh_of(mill.bodies[k].shape)}, this->run.body_colours[k],
          frame_of(mill.bodies[k].motion, now)});
    for_each_piston(mill.vessel, at.time, [&](std::size_t wall, const Vec3<double>& moved) {
      for (auto& point : s.vessel.walls[wall].points) point += moved;
    });
    for (int i = 0; i < at.simulation.ball_count(); ++i) {
      const auto state = at.state_of(i);
      s.balls.push_back({static_cast<double>(at.simulation.properties(i).radius),
          this->run.ball_colours[i], vector_cast<double>(state.position),
          vector_cast<double>(state.velocity), vector_cast<double>(state.spin)});
    }
    return s;
  }
 private:
  std::vector<model::Mesh> walls_;
};

struct SnapshotKeys {
  static void keys(auto& output, auto&& row) { row(contact_point_key, output.contact_point); }
  /// A snapshot shows one impact unless a key says otherwise: there is a file for each.
  static void check(Section&, const CaseSpec&, OutputSpec& output) {
    if (!output.timer.collisions) output.timer.collisions = 1;
  }
};

/// The mill at each impact of the record, a file each: NAME_<index>.x3d. (thesis D.4.1)
template <class Real> class SnapshotOutput : public SceneOutput<Real> {
 public:
  using SceneOutput<Real>::SceneOutput;

  std::vector<io::WholeFile*> complete() override {
    const auto place = this->place();
    std::vector<io::WholeFile*> all;
    for (const auto& [index, text] : pages_) {
      const auto name =
          place.stem().string() + "_" + std::to_string(index) + place.extension().string();
      auto& file = files_.emplace_back(place.parent_path() / name);
      file.stream() << text;
      file.complete();
      all.push_back(&file);
    }
    return all;
  }
 protected:
  void archive_record(Archive& a) override { a(pages_); }
  void record(const ImpactFacts<Real>& f) override {
    const Real& time = f.time;
    Scene s = this->scene({f, time});
    if (this->spec.contact_point) s.contact = this->contact_at(f.contact_point);
    look_at(this->walls(), frames_around(f.simulation.mill().motion, static_cast<double>(time)), s);
    pages_.emplace_back(f.impact.index, x3d_text(s));
  }
 private:
  /// The vessel frames at `time` and throughout a drive period: pictures of one motion share a
  /// view.
  static std::vector<Frame<double>> frames_around(
      const model::AnyMotion<Real>& motion, double time) {
    constexpr int parts = 64;
    const auto period = static_cast<double>(motion.period());
    const double begin = std::floor(time / period) * period;
    std::vector<Frame<double>> frames{frame_of(motion, time)};
    for (int k = 0; k < parts; ++k) frames.push_back(frame_of(motion, begin + period * k / parts));
    return frames;
  }

  std::list<io::AtomicFile> files_;
  std::vector<std::pair<std::uint64_t, std::string>> pages_;
};

/// A file with a frame at the start of the record, after each interval, and at its end.
template <class Real>
class FramesOutput : public OneFileOutput<Real, io::AtomicFile, SceneOutput<Real>> {
 public:
  /// @param interval  its `interval` and `max_rows` are those of the frames
  FramesOutput(const OutputSpec& spec, const RunContext<Real>& run, const TimerSpec& interval)
      : OneFileOutput<Real, io::AtomicFile, SceneOutput<Real>>(spec, run), clock_(interval) {}
 protected:
  virtual void add_frame(const Moment<Real>& at) = 0;

  void before(const ImpactFacts<Real>& f) override {
    const Real& now = f.time;
    if (complete_ || now < this->timer().from()) return;
    const auto frame = [&](const Real& time) { add_frame({f, time}); };
    if (!begun_) frame(this->timer().from());
    begun_ = true;
    clock_.pass(this->timer(), now, [&](const Real&, const Real& end) { frame(end); });
    complete_ = this->timer().ends_by(now);
    if (complete_) frame(this->timer().until(now));
  }
  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    const auto frame = [&](const Real& time) { add_frame({simulation, time}); };
    const Real& from = this->timer().from();
    if (!begun_) frame(from);
    if (!complete_) clock_.finish(from, until, [&](const Real&, const Real& end) { frame(end); });
  }
  void archive_record(Archive& a) override { a(clock_, begun_, complete_); }
 private:
  IntervalClock<Real> clock_;
  bool begun_ = false, complete_ = false;
};

struct AnimationKeys {
  static void keys(auto& output, auto&& row) {
    row(contact_point_key, output.contact_point);
    casefile::AnimationSpec::keys(output.animation, row);
  }
};

/// The record as one X3D page that plays it. (thesis D.4.2)
/// A ball has keys at its impacts and at the frames, between which its path looks straight.
template <class Real> class AnimationOutput : public FramesOutput<Real> {
 public:
  AnimationOutput(const OutputSpec& spec, const RunContext<Real>& run)
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
    paths_.contact.emplace_back(
        key, paths_.contact.empty() ? contact.position : paths_.contact.back().second);
    paths_.contact.emplace_back(key, contact.position);
  }
  void end_of_record(const Simulation<Real>& simulation, const Real& until) override {
    FramesOutput<Real>::end_of_record(simulation, until);
    write(simulation, static_cast<double>(this->timer().from()), static_cast<double>(until));
  }
  void archive_record(Archive& a) override {
    FramesOutput<Real>::archive_record(a);
    a(first_, paths_, frames_);
    const auto balls = this->run.ball_colours.size();
    if (first_ ? first_->balls.size() != balls || paths_.balls.size() != balls
               : !paths_.balls.empty())
      throw InputError("the saved animation is of other balls");
  }
 private:
  static TimerSpec frames_of(const casefile::AnimationSpec& a) {
    TimerSpec timer;
    timer.interval =
        a.speed * Quantity{60} / Quantity(static_cast<std::int64_t>(a.frames_per_minute));
    return timer;
  }

  void add_frame(const Moment<Real>& at) override {
    if (!first_) {
      first_ = this->scene(at);
      paths_.balls.resize(first_->balls.size());
    }
    for (int i = 0; i < at.simulation.ball_count(); ++i)
      add_key(i, at.time, at.state_of(i).position);
    ++frames_;
  }
  void add_key(int ball, const Real& time, const Vec3<Real>& place) {
    paths_.balls[ball].emplace_back(static_cast<double>(time), vector_cast<double>(place));
  }

  void write(const Simulation<Real>& simulation, double from, double until) {
    const double length = until > from ? until - from : 1;
    const auto to_fractions = [&](SceneMotion::Path& path) {
      for (auto& [key, place] : path) key = (key - from) / length;
    };
    for (auto& path : paths_.balls) to_fractions(path);
    to_fractions(paths_.contact);
    const auto& motion = simulation.mill().motion;
    const auto& vessel = simulation.mill().vessel;
    // The vessel has a key for each frame at least, and 64 for each turn of the drive or a piston.
    const auto& bodies = simulation.mill().bodies;
    double frequency = 1 / static_cast<double>(motion.period());
    const auto see = [&](const Real& f) {
      frequency = std::max(frequency, std::abs(static_cast<double>(f)));
    };
    if (const auto* pistons = vessel.pistons())
      for (const auto& piston : pistons->given())
        for (const auto& swing : piston.swings) see(swing.frequency);
    for (const auto& body : bodies)
      for (const auto& joint : body.motion.joints().list) {
        if (joint.rotates) see(joint.speed);
        for (const auto& swing : joint.swings) see(swing.frequency);
      }
    const double turns = length * frequency;
    const auto keys = std::max({this->spec.animation.min_frames, frames_ - 1,
        static_cast<std::uint64_t>(std::ceil(64 * turns))});
    paths_.bodies.resize(bodies.size());
    std::vector<Vec3<double>> at_first;  // the pistons
    for (std::uint64_t k = 0; k <= keys; ++k) {
      const double key = static_cast<double>(k) / static_cast<double>(keys);
      paths_.vessel.emplace_back(key, frame_of(motion, from + length * key));
      for (std::size_t body = 0; body < paths_.bodies.size(); ++body)
        paths_.bodies[body].emplace_back(key, frame_of(bodies[body].motion, from + length * key));
      std::size_t piston = 0;
      this->for_each_piston(
          vessel, Real(from + length * key), [&](std::size_t wall, const auto& moved) {
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

struct ParaviewKeys {
  static void keys(auto& output, auto&& row) {
    row(interval_key("10 ms"), output.timer.interval);
    row(max_rows_key(), output.timer.max_rows);
  }
};

/// Frames for ParaView: NAME.pvd, and a folder NAME with balls and vessel of each frame as VTP.
template <class Real> class ParaviewOutput : public FramesOutput<Real> {
 public:
  ParaviewOutput(const OutputSpec& spec, const RunContext<Real>& run)
      : FramesOutput<Real>(spec, run, spec.timer),
        folder_(std::filesystem::path(this->place()).replace_extension()) {
    std::error_code ignored;
    if (std::filesystem::exists(folder_, ignored) &&
        !std::filesystem::is_directory(folder_, ignored))
      throw InputError(folder_.string() + ": found a file, expected a folder");
  }

  std::vector<io::WholeFile*> complete() override {
    std::vector<std::pair<double, std::vector<std::string>>> list;
    for (std::size_t frame = 0; frame < times_.size(); ++frame) {
      auto& names = list.emplace_back(times_[frame], std::vector<std::string>{}).second;
      for (const char* of : {"balls", "vessel"})
        names.push_back((folder_.filename() / name_of(of, frame)).generic_string());
    }
    this->file_.stream() << pvd_text(list);
    std::filesystem::create_directories(folder_);
    std::vector<io::WholeFile*> all;
    for (auto& frame : frames_) all.push_back(&frame);
    this->file_.complete();
    all.push_back(&this->file_);
    return all;
  }
 protected:
  void record(const ImpactFacts<Real>& f) override {
    doses_.resize(static_cast<std::size_t>(f.simulation.ball_count()), 0);
    const auto dose = static_cast<double>(f.outcome.milling_dose);
    doses_[f.impact.ball] += dose;
    if (!f.impact.with_wall) doses_[f.impact.partner] += dose;
  }
  void archive_record(Archive& a) override {
    FramesOutput<Real>::archive_record(a);
    a(times_, doses_);
    for (std::size_t frame = 0; a.loading() && frame < times_.size(); ++frame)
      add_files(frame, "", "");
    for (auto& frame : frames_) a(frame);
  }
 private:
  void add_frame(const Moment<Real>& at) override {
    Scene s = this->scene(at);
    for (std::size_t i = 0; i < doses_.size(); ++i) s.balls[i].milling_dose = doses_[i];
    times_.push_back(s.time);
    add_files(times_.size() - 1, vtp_balls(s), vtp_vessel(s));
  }
  static std::string name_of(const std::string& of, std::size_t frame) {
    return of + "_" + std::to_string(frame) + ".vtp";
  }
  void add_files(std::size_t frame, const std::string& balls, const std::string& vessel) {
    const auto add = [&](const char* of, const std::string& text) {
      // The folder may be a link, and is made when the run has ended.
      auto& file = frames_.emplace_back(
          folder_ / name_of(of, frame), false, std::filesystem::weakly_canonical(folder_));
      file.stream() << text;
      file.complete();
    };
    add("balls", balls);
    add("vessel", vessel);
  }

  std::filesystem::path folder_;
  std::list<io::AtomicFile> frames_;
  std::vector<double> times_;  ///< of the frames [s]
  std::vector<double> doses_;
};

}  // namespace edmill::output
