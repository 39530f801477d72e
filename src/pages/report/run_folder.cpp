#include "report/run_folder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "casefile/case_spec.hpp"
#include "io/json_file.hpp"
#include "model/parts/partners.hpp"
#include "report/embedded.hpp"

namespace edmill::report {

namespace {

using nlohmann::json;

/// Finds keys and collects their problems.
class Reader {
 public:
  Reader(std::string file, const json& root) : file_(std::move(file)), root_(root) {}

  /// @param path  "/collisions/wall_0"
  void number(const std::string& path, double& value) { read(path, "a number", value); }
  void text(const std::string& path, std::string& value) { read(path, "a text", value); }
  void end_reason(const std::string& path, model::EndReason& value) {
    constexpr const char* expected = "why the run ended";
    std::string name;
    if (!read(path, expected, name)) return;
    if (const auto reason = model::end_reason_named(name))
      value = *reason;
    else
      add_problem(path, expected);
  }
  /// @return whether a value was found that JSON has as a T
  template <class T>
  bool read(const std::string& path, const std::string& expected, T& value) try {
    value = root_.at(json::json_pointer(path)).get<T>();
    return true;
  } catch (const json::exception&) {
    add_problem(path, expected);
    return false;
  }
  bool has_number(const std::string& path) const {
    return has(path) && root_.at(json::json_pointer(path)).is_number();
  }
  bool has(const std::string& path) const { return root_.contains(json::json_pointer(path)); }
  void throw_problems() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  void add_problem(const std::string& path, const std::string& expected) {
    std::string key = path.substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    const std::string found =
        has(path) ? root_.at(json::json_pointer(path)).dump().substr(0, 40) : std::string("nothing");
    problems_.push_back(fmt::format("{}: {}: found {}, expected {}", file_, key, found, expected));
  }

  std::string file_;
  const json& root_;
  std::vector<std::string> problems_;
};

void read_intervals(Reader& reader, RunFacts& f) {
  if (reader.has("/intervals")) {  // not in those of 1.0
    reader.number("/intervals/batches", f.batches);
    reader.number("/intervals/batch_length", f.batch_length);
    for (const char* rate : {"milling_dose_rate", "inverse_milling_dose_rate", "specific_milling_dose_rate",
                             "wall_work_rate", "collision_rate/total"})
      if (const std::string path = std::string("/intervals/") + rate; reader.has(path))
        reader.number(path, f.half_widths[rate]);
    reader.read("/warnings", "texts by their kinds", f.warnings);
  }
  if (reader.has("/target")) {
    reader.number("/target/dose", f.target_dose.emplace());
    reader.text("/target/counts", f.target_counts);
    if (reader.has_number("/target/milling_time"))
      reader.number("/target/milling_time", f.milling_time.emplace());
    if (reader.has_number("/target/milling_time_half_width"))
      reader.number("/target/milling_time_half_width", f.milling_time_half_width.emplace());
  }
}

/// Trends of the impacts with one partner.
std::string partner_trends(const std::string& key, const std::string& only) {
  return fmt::format(R"(
[[output]]
type = "trends"
folder = "report"
file = "trends_{}.csv"
only = {{ {} }}
columns = [{{ variable = "milling_dose", statistics = ["rate"] }}, {{ variable = "collision", statistics = ["rate"] }}]
)",
                     key, only);
}

/// Order of magnitude of what an impact can dissipate: that of the heaviest ball at three times the peak
/// speed of the vessel's centre, at that of its walls, or fallen through it [log10 J]
double largest_energy(const casefile::CaseSpec& spec) {
  const auto mill = casefile::build_mill<double>(spec);
  const double extent = mill.vessel.extent(), centre = 3 * mill.motion.wall_speed(0),
               walls = mill.motion.wall_speed(extent);
  const double square = centre * centre + walls * walls + 4 * norm<double>(mill.gravity) * extent;
  double heaviest = 0;
  const auto weigh = [&](const casefile::BallSpec& ball) {
    heaviest = std::max(heaviest, ball.density.to<double>() * std::pow(ball.diameter.to<double>(), 3) / 2);
  };
  for (const auto& ball : spec.balls) weigh(ball);
  for (const auto& batch : spec.batches) weigh(batch);
  return std::log10(heaviest * square);
}

/// Spectra of energy: from 1e-9 to 1 J, or nine decades below what the impacts of very small or large mills
/// dissipate.
std::string energy_spectra(const casefile::CaseSpec& spec) {
  const double most = largest_energy(spec);
  const int top = std::isfinite(most) && (most < -6 || most > 0) ? static_cast<int>(std::ceil(most)) : 0;
  return fmt::format(
      "\n[[output]]\ntype = \"spectra\"\nfolder = \"report\"\nfile = \"spectra_energy.csv\"\n"
      "low = \"1e{} J\"\nhigh = \"1e{} J\"\n",
      top - 9, top);
}

std::string outputs_for(const casefile::CaseSpec& spec) {
  const auto partners = casefile::partners_of(spec);
  std::string text = std::string(outputs_toml) + energy_spectra(spec);
  for (int wall = 0; wall < partners.walls(); ++wall)
    text += partner_trends(partners[wall].key, fmt::format("ball_ball = false, partner = {}", wall));
  return text + partner_trends(partners[partners.ball_ball()].key, "ball_ball = true");
}

/// The walls are those that the file counts impacts with.
RunFacts read_run_facts(const std::filesystem::path& file) {
  const json root = io::read_json(file, "the summary of a run");
  Reader reader(file.string(), root);
  RunFacts f;
  for (const auto& [key, value] : {std::pair{"/version", &f.version},
                                   {"/commit", &f.commit},
                                   {"/compiler", &f.compiler},
                                   {"/case_file", &f.case_file},
                                   {"/case_digest", &f.case_digest},
                                   {"/precision", &f.precision}})
    reader.text(key, *value);
  reader.read("/settings", "a list of texts", f.settings);
  reader.read("/reported", "true or false", f.reported);
  reader.end_reason("/end_reason", f.end_reason);
  if (reader.has("/error")) reader.text("/error", f.error);
  for (const auto& [key, value] : {std::pair{"/seed", &f.seed},
                                   {"/start_time", &f.start_time},
                                   {"/end_time", &f.end_time},
                                   {"/milling_dose", &f.milling_dose},
                                   {"/wall_work", &f.wall_work},
                                   {"/energy/kinetic_start", &f.kinetic_start},
                                   {"/energy/potential_start", &f.potential_start},
                                   {"/energy/kinetic_end", &f.kinetic_end},
                                   {"/energy/potential_end", &f.potential_end},
                                   {"/energy/closure", &f.closure},
                                   {"/least_separation/impact_share", &f.touched_impact_share},
                                   {"/least_separation/milling_dose_share", &f.touched_dose_share},
                                   {"/stalls/impact_share", &f.stall_impact_share},
                                   {"/stalls/milling_dose_share", &f.stall_dose_share},
                                   {"/least_separation/supplied_energy", &f.supplied_energy},
                                   {"/deepest_overlap", &f.deepest_overlap},
                                   {"/impacts_since_start", &f.impacts_since_start},
                                   {"/cpu_seconds", &f.cpu_seconds}})
    reader.number(key, *value);
  int walls = 0;
  while (reader.has("/collisions/" + model::partner_key(walls, walls + 1))) ++walls;
  for (int k = 0; k <= walls; ++k) {
    reader.number("/collisions/" + model::partner_key(k, walls), f.collisions.emplace_back());
    reader.number("/milling_dose_by_partner/" + model::partner_key(k, walls), f.dose.emplace_back());
  }
  read_intervals(reader, f);
  if (reader.has("/right_digits")) reader.number("/right_digits", f.right_digits.emplace());
  if (reader.has("/powder_mass")) reader.number("/powder_mass", f.powder_mass.emplace());
  reader.throw_problems();
  return f;
}

}  // namespace

RunFolder read_run_folder(const std::filesystem::path& place) {
  RunFolder folder{place, read_run_facts(place / "summary.json"), {}, {}};
  folder.spec = casefile::read_case_of_run((place / "case.toml").string(), folder.facts.settings,
                                           folder.facts.case_digest);
  folder.partners = casefile::partners_of(folder.spec);
  if (const auto found = folder.facts.collisions.size() - 1,
      expected = static_cast<std::size_t>(folder.partners.walls());
      found != expected)
    throw InputError(fmt::format("{}: collisions: found {} walls, expected the {} of the case",
                                 (place / "summary.json").string(), found, expected));
  if (folder.facts.reported) add_report_outputs(folder.spec);
  return folder;
}

std::filesystem::path RunFolder::file_of(const casefile::OutputSpec& output) const {
  return place / output.folder / output.file;
}

const casefile::OutputSpec* RunFolder::output(std::string_view type, const Fits& fits) const {
  const auto is_written = [&](const casefile::OutputSpec& output) {
    std::error_code ignored;
    const auto file = file_of(output);
    // The file of a record that never began is empty.
    return std::filesystem::is_regular_file(file, ignored) && std::filesystem::file_size(file, ignored) > 0;
  };
  // The report's own outputs come last, and are certain to fit.
  for (auto output = spec.outputs.rbegin(); output != spec.outputs.rend(); ++output)
    if (output->type == type && !output->append && output->timer.on && !output->file.ends_with(".h5") &&
        is_written(*output) && fits(*output))
      return &*output;
  return nullptr;
}

void add_report_outputs(casefile::CaseSpec& spec) {
  using casefile::Quantity;
  const auto before = spec.outputs.size();
  spec.reported = true;
  casefile::add_outputs(outputs_for(spec), "the outputs of the report", spec);
  const bool moving = casefile::name_of(spec.mill) != "still";
  // Powers of pi in the drive's period may be rounded: these are only sampling times.
  const auto period =
      moving ? Quantity::exactly(casefile::period_of(spec.mill).to<double>()) : Quantity{1, 20};
  for (auto k = before; k < spec.outputs.size(); ++k) {
    auto& output = spec.outputs[k];
    if (output.type == "trends") {
      output.timer.interval = period;  // whole drive periods can be compared
    } else if (output.type == "trends_balls") {
      output.timer.interval = period * Quantity{2, 5};  // 5 phases of the drive in turn
    } else {
      output.timer.start_time = spec.statistics_start;
    }
    if (output.type == "animation") {
      output.timer.duration = period * Quantity{spec.ball_count() > 200 ? 1 : 2};
      output.animation.speed = period / Quantity{4};  // a period takes 4 s
      output.animation.frames_per_minute = 20 * 60;
    }
    if (output.type == "frequency" && moving) {
      // Balls are rarely faster than three times the peak speed of the vessel's centre.
      const double fastest = 3 * casefile::build_mill<double>(spec).motion.wall_speed(0);
      if (fastest > 0) output.frequency.high = Quantity::exactly(fastest);
    }
  }
}

}  // namespace edmill::report
