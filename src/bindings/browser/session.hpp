// A run that a page shows while it goes on.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "base/digest.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "browser/case_with_values.hpp"
#include "casefile/build_case.hpp"
#include "edmill/run.hpp"
#include "io/input_file.hpp"
#include "io/json_text.hpp"
#include "model/mill.hpp"
#include "model/parts/surface.hpp"
#include "output/scene.hpp"
#include "run/case_access.hpp"

namespace edmill::browser {

class Session : private Observer<double> {
 public:
  /// @param settings  "section.key=value" over the text, whose own outputs are left out
  /// @param log       whether collisions.csv is written
  /// @throws InputError with all problems of the case
  Session(const std::string& text, const std::vector<std::string>& settings, bool log)
      : spec_(read(text, settings, log)),
        mill_(casefile::build_mill<double>(spec_)),
        run_(CaseAccess::make(spec_)),
        log_(log) {
    run_.write_to(folder);
    run_.attach(*this);
  }

  /// What stands still, as JSON: radii, walls as meshes, names of partners, digest of the case, the period.
  void scene(io::JsonText& json) const {
    json.add("version", version());
    json.add("case_digest", spec_.digest);
    json.add("period", mill_.motion.period());
    json.add("start", spec_.statistics_start.to<double>());
    if (spec_.end_time) json.add("end", spec_.end_time->to<double>());
    json.add("balls", run_.ball_count());
    std::vector<double> radii;
    for (const auto& batch : spec_.batches)
      radii.insert(radii.end(), batch.count, batch.diameter.to<double>() / 2);
    for (const auto& ball : spec_.balls) radii.push_back(ball.diameter.to<double>() / 2);
    json.add("radii", radii);
    const auto partners = casefile::partners_of(spec_);
    std::vector<std::string> names;
    for (int k = 0; k < partners.count(); ++k) names.push_back(partners[k].label);
    json.add("partners", names);
    json.add("middle", coordinates(std::array{mill_.motion.middle()}));
    json.begin("walls");
    int wall = 0;
    for (const auto& surface : mill_.vessel.surfaces()) {
      const auto mesh = model::mesh_of(surface);
      json.begin(std::to_string(wall++));
      json.add("points", coordinates(mesh.points));
      std::vector<int> corners;  // of each face, after their number
      for (const auto& face : mesh.faces) {
        corners.push_back(static_cast<int>(face.size()));
        corners.insert(corners.end(), face.begin(), face.end());
      }
      json.add("faces", corners);
      json.end();
    }
    json.end();
  }

  /// Simulates up to a time [s].
  void advance_to(double time) {
    if (going_on_) going_on_ = run_.advance_to(time);
  }
  /// Simulates to the next impact, but for no longer than a hundred drive periods.
  void advance_one_impact() {
    const auto before = impacts_;
    const double now = run_.time();
    double step = impacts_ > 0 ? now / static_cast<double>(impacts_) / 1000 : 1e-6;
    const double latest = now + 100 * mill_.motion.period();
    for (double time = now; going_on_ && impacts_ == before && time < latest; step *= 1.1)
      advance_to(time += step);
  }

  /// The present state as JSON: places, the vessel's frame, rates with intervals, counts by approach speed.
  void frame(io::JsonText& json) {
    const double now = run_.time();
    const auto summary = run_.summary();
    json.add("time", now);
    json.add("impacts", impacts_);
    json.add("ended", !going_on_);
    json.add("end_reason", summary.end_reason);
    std::vector<Vector<double>> places;
    for (int k = 0; k < run_.ball_count(); ++k) places.push_back(run_.ball(k).position);
    json.add("places", coordinates(places));
    const auto frame = output::vessel_frame(mill_.motion, now);
    json.add("vessel", coordinates(std::array{frame.origin, frame.x, frame.y, frame.z}));
    if (impacts_ > 0) {
      json.begin("last");
      json.add("time", last_.time);
      json.add("ball", last_.ball);
      json.add("partner", last_.partner);
      json.add("with_wall", last_.with_wall);
      json.add("approach_speed", last_.approach_speed);
      json.add("slip_speed", last_.slip_speed);
      json.add("separation_speed", last_.separation_speed);
      json.add("milling_dose", last_.milling_dose);
      json.end();
    }
    if (now > summary.start_time) {
      json.add("dose", summary.milling_dose);
      json.add("dose_rate", summary.milling_dose_rate());
      if (summary.milling_dose_rate_half_width) json.add("half_width", *summary.milling_dose_rate_half_width);
      json.add("collisions", summary.collisions);
      json.add("dose_by_partner", summary.dose_by_partner);
    }
    json.add("speeds", by_speed_);
  }

  /// The case with the settings in it, as a file that the command line runs: with the same log, if any.
  std::string case_text() const { return text_with_values(spec_, log_); }

  /// The summary, and the SHA-256 of collisions.csv as the command line writes it. Nothing can follow.
  void finish(io::JsonText& json) {
    if (!finished_) run_.commit();
    finished_ = true;
    const auto log = io::content_of(std::string(folder) + "/collisions.csv");
    if (!log.empty()) json.add("digest", sha256(log));
    json.add("summary", io::content_of(std::string(folder) + "/summary.json"));
  }

 private:
  static constexpr const char* folder = "/run";

  /// Of vectors, one after the other.
  static std::vector<double> coordinates(const auto& vectors) {
    std::vector<double> list;
    for (const auto& v : vectors) list.insert(list.end(), {v[0], v[1], v[2]});
    return list;
  }
  static casefile::CaseSpec read(const std::string& text, const std::vector<std::string>& settings,
                                 bool log) {
    constexpr std::size_t most_balls = 5000;
    auto spec = casefile::parse_case(text, "case.toml", settings);
    if (spec.precision != "double" || spec.digits)
      throw InputError("case.toml: found " +
                       (spec.digits ? "run.digits" : "run.precision = \"" + spec.precision + "\"") +
                       ", expected a run in double: this page has no other numbers; the command line has");
    if (spec.ball_count() > most_balls)
      throw InputError(std::to_string(spec.ball_count()) +
                       " balls are too many to be drawn: this page takes up to " +
                       std::to_string(most_balls) + "; the command line takes any number.");
    spec.outputs.clear();
    if (log) casefile::add_outputs("[[output]]\ntype = \"collisions\"\n", "the page's output", spec);
    return spec;
  }
  void on_impact(const Impact<double>& impact, Run<double>&) override {
    ++impacts_;
    last_ = impact;
    if (impact.time < spec_.statistics_start.to<double>()) return;
    constexpr int count = std::tuple_size_v<decltype(by_speed_)>;
    const double place = std::log10(std::max(impact.approach_speed, 1e-3) / 1e-3) * count / 4;
    ++by_speed_[static_cast<std::size_t>(std::min(place, count - 1.0))];
  }

  casefile::CaseSpec spec_;
  model::Mill<double> mill_;
  Run<double> run_;
  std::array<std::uint64_t, 40> by_speed_{};  ///< impacts, in classes of equal ratio from 1 mm/s to 10 m/s
  std::uint64_t impacts_ = 0;
  Impact<double> last_{};
  bool log_, going_on_ = true, finished_ = false;
};

}  // namespace edmill::browser
