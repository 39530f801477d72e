#include "study/run_record.hpp"

#include <boost/property_tree/json_parser.hpp>
#include <boost/property_tree/ptree.hpp>
#include <cmath>
#include <sstream>

#include "base/scalar_list.hpp"
#include "base/version.hpp"
#include "io/json_text.hpp"

namespace edmill {
extern template std::string to_text<double>(const double&);
extern template double from_text<double>(const std::string&);
}  // namespace edmill

namespace edmill::study {

namespace {

constexpr const char* format_name = "edmill run record 1";
constexpr bool rates_are_those_of_the_partners() {
  for (std::size_t k = 0; k < model::partners.size(); ++k)
    if (quantity_names[4 + k].substr(std::string_view("collision_rate_").size()) != model::partners[k].key)
      return false;
  return true;
}
static_assert(rates_are_those_of_the_partners());

}  // namespace

RunRecord failed_run(const std::string& digest, const std::string& status, const std::string& message) {
  RunRecord record;
  record.digest = digest;
  record.status = status;
  for (const char c : message) record.message += c == '\n' ? std::string("; ") : std::string(1, c);
  return record;
}

std::string to_json(const RunRecord& r) {
  io::JsonText json;
  json.text("format", format_name);
  json.text("version", version());
  json.text("commit", commit());
  json.text("case_digest", r.digest);
  json.text("status", r.status);
  json.text("end_reason", r.end_reason);
  json.text("message", r.message);
  json.number("start_time", r.start_time);
  json.number("end_time", r.end_time);
  json.begin("collisions");
  for (std::size_t k = 0; k < model::partners.size(); ++k)
    json.integer(model::partners[k].key, r.collisions[k]);
  json.end();
  json.number("milling_dose", r.milling_dose);
  json.number("wall_work", r.wall_work);
  if (r.powder_mass) json.number("powder_mass", *r.powder_mass);
  if (r.ball_mass) json.number("ball_mass", *r.ball_mass);
  json.number("cpu_seconds", r.cpu_seconds);
  return json.finish();
}

std::optional<RunRecord> from_json(const std::string& text) try {
  std::istringstream in(text);
  boost::property_tree::ptree tree;
  boost::property_tree::read_json(in, tree);
  const auto word = [&](const char* key) { return tree.get<std::string>(key); };
  const auto number = [&](const char* key) { return from_text<double>(word(key)); };
  const auto number_if_there = [&](const char* key) {
    return tree.get_child_optional(key) ? std::optional<double>(number(key)) : std::nullopt;
  };
  if (word("format") != format_name || word("version") != version() || word("commit") != commit())
    return std::nullopt;
  RunRecord r;
  r.digest = word("case_digest");
  r.status = word("status");
  r.end_reason = word("end_reason");
  r.message = word("message");
  r.start_time = number("start_time");
  r.end_time = number("end_time");
  const auto& collisions = tree.get_child("collisions");
  for (std::size_t k = 0; k < model::partners.size(); ++k)
    r.collisions[k] = collisions.get<std::uint64_t>(model::partners[k].key);
  r.milling_dose = number("milling_dose");
  r.wall_work = number("wall_work");
  r.powder_mass = number_if_there("powder_mass");
  r.ball_mass = number_if_there("ball_mass");
  r.cpu_seconds = number("cpu_seconds");
  return r;
} catch (const std::exception&) {
  return std::nullopt;
}

Quantities quantities_of(const RunRecord& r) {
  Quantities q;
  const double duration = r.end_time - r.start_time;
  if (duration <= 0) return q;
  if (r.milling_dose > 0) q[0] = duration / r.milling_dose;
  q[1] = r.milling_dose / duration;
  if (r.powder_mass) q[2] = r.milling_dose / *r.powder_mass / duration;
  q[3] = r.wall_work / duration;
  std::uint64_t total = 0;
  for (std::size_t k = 0; k < r.collisions.size(); ++k) {
    q[4 + k] = static_cast<double>(r.collisions[k]) / duration;
    total += r.collisions[k];
  }
  q[8] = static_cast<double>(total) / duration;
  return q;
}

}  // namespace edmill::study
