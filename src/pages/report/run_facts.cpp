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
  void number(const std::string& path, double& value) {
    if (const json* found = find(path, "a number", [](const json& j) { return j.is_number(); }))
      value = found->get<double>();
  }
  void text(const std::string& path, std::string& value) {
    if (const json* found = find(path, "a text", [](const json& j) { return j.is_string(); }))
      value = found->get<std::string>();
  }
  void texts(const std::string& path, std::vector<std::string>& values) {
    const auto all_texts = [](const json& j) {
      return j.is_array() && std::all_of(j.begin(), j.end(), [](const json& one) { return one.is_string(); });
    };
    if (const json* found = find(path, "a list of texts", all_texts))
      values = found->get<std::vector<std::string>>();
  }
  void flag(const std::string& path, bool& value) {
    if (const json* found = find(path, "true or false", [](const json& j) { return j.is_boolean(); }))
      value = found->get<bool>();
  }
  void end_reason(const std::string& path, model::EndReason& value) {
    const auto known = [](const json& j) {
      return j.is_string() && model::end_reason_named(j.get<std::string>()).has_value();
    };
    if (const json* found = find(path, "why the run ended", known))
      value = *model::end_reason_named(found->get<std::string>());
  }
  void texts_by_key(const std::string& path, std::map<std::string, std::string>& values) {
    const auto all_texts = [](const json& j) {
      return j.is_object() &&
             std::all_of(j.begin(), j.end(), [](const json& one) { return one.is_string(); });
    };
    if (const json* found = find(path, "texts by their kinds", all_texts))
      values = found->get<std::map<std::string, std::string>>();
  }
  bool has_number(const std::string& path) const {
    return has(path) && root_.at(json::json_pointer(path)).is_number();
  }
  bool has(const std::string& path) const { return root_.contains(json::json_pointer(path)); }
  void throw_problems() const {
    if (!problems_.empty()) throw InputError(problems_);
  }

 private:
  template <class Test>
  const json* find(const std::string& path, const std::string& expected, Test&& test) {
    const json* found = has(path) ? &root_.at(json::json_pointer(path)) : nullptr;
    if (found && test(*found)) return found;
    std::string key = path.substr(1);
    std::replace(key.begin(), key.end(), '/', '.');
    problems_.push_back(fmt::format("{}: {}: found {}, expected {}", file_, key,
                                    found ? found->dump().substr(0, 40) : "nothing", expected));
    return nullptr;
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
    reader.texts_by_key("/warnings", f.warnings);
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
  reader.texts("/settings", f.settings);
  reader.flag("/reported", f.reported);
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
