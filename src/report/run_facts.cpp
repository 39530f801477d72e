#include "report/run_facts.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "io/json_file.hpp"
#include "model/parts/partners.hpp"

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

}  // namespace

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

}  // namespace edmill::report
