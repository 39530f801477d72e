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
        folder_(std::filesystem::path(this->place()).replace_extension()) {
    std::error_code ignored;
    if (std::filesystem::exists(folder_, ignored) && !std::filesystem::is_directory(folder_, ignored))
      throw InputError(folder_.string() + ": found a file, expected a place for a folder");
  }

  void complete() override {
    std::vector<std::pair<double, std::vector<std::string>>> list;
    for (std::size_t frame = 0; frame < times_.size(); ++frame) {
      auto& names = list.emplace_back(times_[frame], std::vector<std::string>{}).second;
      for (const char* of : {"balls", "vessel"})
        names.push_back((folder_.filename() / name_of(of, frame)).generic_string());
    }
    this->file_.stream() << pvd_text(list);
    this->file_.complete();
  }
  void commit() override {
    std::filesystem::create_directories(folder_);
    frames_.commit();
    this->file_.commit();
  }
  std::vector<std::filesystem::path> places() const override {
    auto places = frames_.places();
    for (auto& place : this->file_.places()) places.push_back(std::move(place));
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
    a(times_, doses_);
    for (std::size_t frame = 0; a.loading() && frame < times_.size(); ++frame) add_files(frame, "", "");
    a(frames_);
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
      frames_.add(
          folder_ / name_of(of, frame), [&](std::ostream& out) { out << text; },
          std::filesystem::weakly_canonical(folder_));
    };
    add("balls", balls);
    add("vessel", vessel);
  }

  std::filesystem::path folder_;
  io::AtomicFiles frames_;
  std::vector<double> times_;  ///< of the frames [s]
  std::vector<double> doses_;
};

}  // namespace edmill::output
