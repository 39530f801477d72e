// The mill at each impact of the record, a file each: NAME_<index>.x3d. (thesis D.4.1)
#pragma once

#include <cmath>

#include "casefile/output_entry.hpp"
#include "io/atomic_file.hpp"
#include "output/scene_output.hpp"

namespace edmill::output {

struct SnapshotKeys {
  static void keys(auto& output, auto&& row) { row(casefile::contact_point_key, output.contact_point); }
  /// A snapshot shows one impact unless a key says otherwise: there is a file for each.
  static void check(casefile::Section&, const casefile::CaseSpec&, casefile::OutputSpec& output) {
    if (!output.timer.collisions) output.timer.collisions = 1;
  }
};

template <class Real>
class SnapshotOutput : public SceneOutput<Real> {
 public:
  using SceneOutput<Real>::SceneOutput;

  void complete() override {
    const auto place = this->place();
    for (const auto& [index, text] : pages_) {
      const auto name = place.stem().string() + "_" + std::to_string(index) + place.extension().string();
      files_.add(place.parent_path() / name, [&page = text](std::ostream& out) { out << page; });
    }
  }
  void commit() override { files_.commit(); }
  std::vector<std::filesystem::path> places() const override { return files_.places(); }

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
  /// Frames of a drive period, so that pictures of a periodic motion have one viewer, and of a time in it.
  static std::vector<Frame<double>> frames_around(const model::AnyMotion<Real>& motion, double time) {
    constexpr int parts = 64;
    const auto period = static_cast<double>(motion.period());
    const double begin = std::floor(time / period) * period;
    std::vector<Frame<double>> frames{vessel_frame(motion, time)};
    for (int k = 0; k < parts; ++k) frames.push_back(vessel_frame(motion, begin + period * k / parts));
    return frames;
  }

  io::AtomicFiles files_;
  std::vector<std::pair<std::uint64_t, std::string>> pages_;
};

}  // namespace edmill::output
