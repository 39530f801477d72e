// The C functions that the page calls: texts in, JSON out. A text is valid until the next call.
#include <emscripten.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "audit/audit.hpp"
#include "base/clean_text.hpp"
#include "base/digest.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "casefile/section.hpp"
#include "check.hpp"
#include "compare/comparison.hpp"
#include "edmill/run.hpp"
#include "identify/identify.hpp"
#include "io/input_file.hpp"
#include "io/json_file.hpp"
#include "io/json_text.hpp"
#include "machines/machines.hpp"
#include "model/mill.hpp"
#include "model/parts/surface.hpp"
#include "output/scene.hpp"
#include "run/case_access.hpp"
#include "run/event_source.hpp"

namespace edmill::browser {

namespace {

using io::content_of, io::JsonText;

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

/// The case is the file /case of the page's own memory; /settings has the settings over it.
casefile::CaseSpec the_case() {
  auto settings = lines_of(content_of("/settings"));
  std::erase(settings, "");
  return casefile::parse_case(content_of("/case"), "case.toml", settings);
}

/// The text of a case with another value of a key, or another section.
std::string with_setting(
    const std::string& text, const std::string& key, const std::string& value) {
  const auto root = toml::parse(text);
  auto lines = lines_of(text);
  const auto dot = key.rfind('.');
  const auto* node = casefile::node_at(root, key);
  const auto* table = dot == key.npos ? nullptr : casefile::node_at(root, key.substr(0, dot));
  const auto assigned = key.substr(dot + 1) + " = " + value;  // dot + 1 is 0 without one
  if (dot == key.npos) {
    std::erase_if(lines, [&, inside = false](const std::string& line) mutable {
      if (const auto name = line.find_first_not_of(" ["); trimmed(line).starts_with('['))
        inside = line.compare(name, key.size(), key) == 0 &&
            line.find_first_of(".] ", name) == name + key.size();
      return inside;
    });
    lines.insert(lines.begin(), assigned);
  } else if (node || (table && table->as_table()->is_inline())) {
    const auto& [begin, end, path] = (node ? node : table)->source();
    auto& line = lines.at(begin.line - 1);
    if (node)
      line.replace(begin.column - 1, end.column - begin.column, value);
    else
      line.insert(end.column - 2, ", " + assigned);
  } else if (table) {
    lines.insert(lines.begin() + table->source().begin.line, assigned);
  } else {
    lines.insert(lines.end(), {"", "[" + key.substr(0, dot) + "]", assigned});
  }
  return fmt::format("{}\n", fmt::join(lines, "\n"));
}

/// The text of a case with its settings as values, so that it is the same case without them. Where
/// the text does not allow that, they follow as comments.
/// @param log  whether an output "collisions" is added unless the case has one
std::string text_with_values(const casefile::CaseSpec& spec, bool log) try {
  auto text = spec.text;
  for (const auto& setting : spec.settings) {
    const auto equals = setting.find('=');
    text = with_setting(text, setting.substr(0, equals), setting.substr(equals + 1));
  }
  const auto same = casefile::parse_case(text, spec.file);
  if (same.digest != spec.digest) return casefile::text_with_settings(spec);
  const auto is_log = [](const auto& output) { return output.type == "collisions"; };
  const bool has_log = std::any_of(same.outputs.begin(), same.outputs.end(), is_log);
  return text + (log && !has_log ? "\n[[output]]\ntype = \"collisions\"\n" : "");
} catch (const std::exception&) {
  return casefile::text_with_settings(spec);
}

/// A run that a page shows while it is computed.
class Session : private Observer<double> {
 public:
  /// @param log  whether collisions.csv is written. @throws InputError with the case's problems
  explicit Session(bool log)
      : spec_(read(log)), mill_(casefile::build_mill<double>(spec_)), run_(CaseAccess::make(spec_)),
        log_(log) {
    run_.write_to(folder);
    run_.attach(*this);
  }

  /// Writes what is constant as JSON: radii, walls as meshes, names of partners, the period.
  void scene(JsonText& json) const {
    json.add("version", version(), "period", mill_.motion.period(), "start",
        spec_.statistics_start.to<double>());
    std::vector<double> radii;
    for (const auto& batch : spec_.batches)
      radii.insert(radii.end(), batch.count, batch.diameter.to<double>() / 2);
    for (const auto& ball : spec_.balls) radii.push_back(ball.diameter.to<double>() / 2);
    json.add("radii", radii);
    const auto partners = casefile::partners_of(spec_);
    std::vector<std::string> names;
    for (int k = 0; k < partners.count(); ++k) names.push_back(partners[k].label);
    json.add("partners", names, "middle", mill_.motion.middle());
    json.begin("values");
    for (const auto* key : {"balls.0.count", "balls.0.diameter", "contact.restitution",
             "contact.friction", "mill.speed", "run.max_collisions"})
      if (const auto value = casefile::text_of_key(spec_, key)) json.add(key, *value);
    json.end();
    json.begin("walls");
    int wall = 0;
    for (const auto& surface : mill_.vessel.surfaces()) {
      const auto mesh = model::mesh_of(surface);
      json.add_group(std::to_string(wall++), "points", mesh.points, "faces", mesh.faces);
    }
    json.end();
    json.begin("bodies");
    for (std::size_t k = 0; k < mill_.bodies.size(); ++k)
      json.add_group(std::to_string(k), "points", model::mesh_of(mill_.bodies[k].shape).points,
          "colour", spec_.bodies[k].colour);
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

  /// The present state as JSON: places, frames, rates with intervals, counts by approach speed.
  void frame(JsonText& json) {
    const double now = run_.time();
    const auto summary = run_.summary();
    json.add(
        "time", now, "impacts", impacts_, "ended", !going_on_, "end_reason", summary.end_reason);
    std::vector<Vector<double>> places;
    for (int k = 0; k < run_.ball_count(); ++k) places.push_back(run_.ball(k).position);
    const auto frame_of = [now](const auto& motion) {
      const auto frame = output::frame_of(motion, now);
      return std::array{frame.origin, frame.x, frame.y, frame.z};
    };
    std::vector<std::array<Vec3<double>, 4>> bodies;
    for (const auto& body : mill_.bodies) bodies.push_back(frame_of(body.motion));
    json.add("places", places, "vessel", frame_of(mill_.motion), "bodies", bodies);
    if (impacts_ > 0)
      json.add_group("last", "ball", last_.ball, "partner", last_.partner, "with_wall",
          last_.with_wall, "approach_speed", last_.approach_speed, "separation_speed",
          last_.separation_speed, "milling_dose", last_.milling_dose);
    if (now > summary.start_time) {
      json.add("dose", summary.milling_dose);
      json.begin("results");
      results(json, io::facts_in(nlohmann::json::parse(summary.json), "summary.json"));
      json.end();
      json.add("collisions", summary.collisions, "dose_by_partner", summary.dose_by_partner);
    }
    json.add("speeds", by_speed_);
  }

  /// The case with the settings in it, as a file that the command line runs, with the same log.
  std::string case_text() const { return text_with_values(spec_, log_); }

  /// Ends the run and adds the SHA-256 of collisions.csv, as the command line writes it.
  void finish(JsonText& json) {
    if (!finished_) run_.commit();
    finished_ = true;
    const auto log = content_of(std::string(folder) + "/collisions.csv");
    if (!log.empty()) json.add("digest", sha256(log));
  }
 private:
  static constexpr const char* folder = "/run";

  /// Adds the results in summary.json that the page shows, milling time first.
  static void results(JsonText& json, const io::Facts& summary) {
    if (const auto time = summary.find("target/milling_time"))
      json.add("milling time",
          time_with_interval(*time, summary.find("target/milling_time_half_width")));
    const auto add_rate = [&](const char* name, const std::string& key, const char* unit) {
      if (const auto rate = summary.find(key))
        json.add(name, with_interval(*rate, summary.find("intervals/" + key)) + unit);
    };
    add_rate("milling dose rate", "milling_dose_rate", " W");
    add_rate("impacts above 1 m/s", "fast_impact_rate", " per second");
    const std::string energy = "impact_energy_by_dose/";
    if (const auto half = summary.find(energy + "median"))
      json.add("impact energy",
          "half of the impacts' dose below " + energy_text(*half) + ", 90 % below " +
              energy_text(summary.number(energy + "90_percent")));
    if (const auto speed = summary.find("mean_impact_speed"))
      json.add("mean impact speed", fmt::format("{:.3g} m/s", *speed));
  }

  static casefile::CaseSpec read(bool log) {
    constexpr std::size_t most_balls = 5000;
    auto spec = the_case();
    if (spec.precision != "double" || spec.digits)
      throw InputError("case.toml: found " +
          (spec.digits ? "run.digits" : "run.precision = \"" + spec.precision + "\"") +
          ", expected a run in double: this page has no other precision, the command line has");
    if (spec.ball_count() > most_balls)
      throw InputError(std::to_string(spec.ball_count()) +
          " balls are too many to be drawn: this page takes up to " + std::to_string(most_balls) +
          "; the command line takes any number.");
    spec.outputs.clear();
    if (log)
      casefile::add_outputs("[[output]]\ntype = \"collisions\"\n", "the page's output", spec);
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
  std::array<std::uint64_t, 40> by_speed_{};  ///< in classes of equal ratio from 1 mm/s to 10 m/s
  std::uint64_t impacts_ = 0;
  Impact<double> last_{};
  bool log_, going_on_ = true, finished_ = false;
};

std::unique_ptr<Session> session;
std::string last_answer;

/// Returns the JSON that `work` fills, or the problems that it throws.
const char* answer(const auto& work) {
  JsonText json;
  try {
    work(json);
  } catch (const InputError& error) {
    json = {};
    json.add("problems", error.problems());
  } catch (const std::exception& error) {
    json = {};
    json.add("problems", std::vector<std::string>{error.what()});
  }
  last_answer = json.finish();
  return last_answer.c_str();
}

Session& running() {
  if (!session) throw InputError("no run has begun");
  return *session;
}

/// Sends the current stage of a search to the page, which shows it.
void tell_stage(const std::string& stage) {
  EM_ASM({ postMessage({what : 'stage', stage : UTF8ToString($0)}); }, stage.c_str());
}

/// Records the first impacts of a case, with -1 - number for a wall.
struct FirstImpacts : Observer<double> {
  explicit FirstImpacts(int most) : most(static_cast<std::size_t>(most)) {}
  void on_impact(const Impact<double>& impact, Run<double>& run) override {
    times.push_back(impact.time);
    balls.push_back(impact.ball);
    partners.push_back(impact.with_wall ? -1 - impact.partner : impact.partner);
    if (times.size() == most) run.stop();
  }
  std::size_t most;
  std::vector<double> times;
  std::vector<int> balls, partners;
};

}  // namespace

extern "C" {

/// @param log  whether collisions.csv is written, for its digest
EMSCRIPTEN_KEEPALIVE const char* edmill_begin(int log) {
  return answer([&](JsonText& json) {
    session.reset();
    std::filesystem::remove_all("/run");
    session = std::make_unique<Session>(log != 0);
    session->scene(json);
  });
}

/// Advances the run to a time [s], or by one impact if the time is negative.
EMSCRIPTEN_KEEPALIVE const char* edmill_advance(double time) {
  return answer([&](JsonText& json) {
    if (time < 0)
      running().advance_one_impact();
    else
      running().advance_to(time);
    session->frame(json);
  });
}

/// The mills that `edmill new` knows, by their keys.
EMSCRIPTEN_KEEPALIVE const char* edmill_machines() {
  return answer([&](JsonText& json) {
    for (const auto& machine : machines::catalogue().machines) json.add(machine.key, machine.name);
  });
}

/// A case as by `edmill new`. Lines of /wanted: mill, jar, balls, fill, powder, target dose, speed.
EMSCRIPTEN_KEEPALIVE const char* edmill_new() {
  return answer([&](JsonText& json) {
    machines::Wanted wanted;
    std::string balls;
    std::istringstream in(content_of("/wanted"));
    for (auto* text : {&wanted.machine, &wanted.jar, &balls, &wanted.fill, &wanted.powder,
             &wanted.target_dose, &wanted.speed})
      std::getline(in, *text);
    if (!balls.empty()) wanted.balls = {balls};
    json.add("case", machines::new_case(wanted));
  });
}

EMSCRIPTEN_KEEPALIVE const char* edmill_case() {
  return answer([&](JsonText& json) { json.add("case", running().case_text()); });
}

EMSCRIPTEN_KEEPALIVE const char* edmill_finish() {
  return answer([&](JsonText& json) { running().finish(json); });
}

EMSCRIPTEN_KEEPALIVE const char* edmill_first_impacts(int most) {
  return answer([&](JsonText& json) {
    Run<double> run(CaseAccess::make(the_case()));
    FirstImpacts found(most);
    run.attach(found);
    run.finish();
    json.add("time", found.times, "ball", found.balls, "partner", found.partners);
  });
}

/// The log is the file /log. @param identify  true to search for the mistake behind violations
EMSCRIPTEN_KEEPALIVE const char* edmill_audit(int identify) {
  return answer([&](JsonText& json) {
    const auto spec = the_case();
    auto options = audit::options_of(spec);
    options.log = "/log";
    const auto built = casefile::build_case<double>(spec);
    auto audited = audit::audit(built.the_case, built.states, options);
    audited.case_name = spec.file;
    audited.log_name = "log";
    json.add("verdict", audit::name_of(audited.verdict));
    std::string table = audit::table(audited);
    if (audited.verdict == audit::Verdict::differ)
      table += identify::table(identify::identify(spec, options,
          identify != 0 ? identify::Search::all : identify::Search::single, tell_stage));
    json.add("table", table);
  });
}

/// The certificate is the file /certificate.
EMSCRIPTEN_KEEPALIVE const char* edmill_check() {
  return answer([&](JsonText& json) {
    std::ifstream in("/certificate");
    try {
      json.add("verdict", checker::check(in));
    } catch (const checker::Rejected& why) {
      json.add("verdict", std::string("rejected: ") + why.what());
    } catch (const nlohmann::json::exception&) {
      throw InputError(
          "found a line that is not JSON, expected a file of `edmill prove --certificate`");
    }
  });
}

/// The logs are the files /reference and /log.
EMSCRIPTEN_KEEPALIVE const char* edmill_compare() {
  return answer([&](JsonText& json) {
    compare::ComparisonOptions options;
    options.a = "/reference";
    options.b = "/log";
    const auto comparison = compare::compare(options);
    json.add("verdict", compare::name_of(comparison.verdict), "table", compare::table(comparison));
  });
}
}

}  // namespace edmill::browser

namespace edmill::run {

/// Runs that judges make, in double, which is the only scalar of the page.
std::unique_ptr<EventSource> make_source(const std::string&, const casefile::CaseSpec& spec,
    bool to_end, const std::atomic<bool>* interrupt) {
  return make_source_in<double>(spec, to_end, interrupt);
}

}  // namespace edmill::run
