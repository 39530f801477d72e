// What the page calls, as C functions: texts in, JSON out. A text is valid until the next call.
#include <emscripten.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <nlohmann/json.hpp>
#include <sstream>

#include "audit/audit.hpp"
#include "browser/session.hpp"
#include "casefile/build_case.hpp"
#include "check.hpp"
#include "compare/comparison.hpp"
#include "edmill/run.hpp"
#include "identify/identify.hpp"
#include "io/input_file.hpp"
#include "io/json_text.hpp"
#include "run/case_access.hpp"

namespace {

using edmill::io::content_of;
using edmill::io::JsonText;

std::unique_ptr<edmill::browser::Session> session;

const char* kept(std::string text) {
  static std::string last;
  last = std::move(text);
  return last.c_str();
}

/// What `work` puts into JSON, or the problems that it found.
const char* answer(const auto& work) {
  JsonText problems;
  try {
    JsonText json;
    work(json);
    return kept(json.finish());
  } catch (const edmill::InputError& error) {
    problems.add("problems", error.problems());
  } catch (const std::exception& error) {
    problems.add("problems", std::vector<std::string>{error.what()});
  }
  return kept(problems.finish());
}

/// The case is the file /case of the page's own memory, settings over it are the lines of /settings.
std::string case_text() { return content_of("/case"); }
std::vector<std::string> settings() {
  std::vector<std::string> lines;
  std::istringstream in(content_of("/settings"));
  for (std::string line; std::getline(in, line);)
    if (!line.empty()) lines.push_back(line);
  return lines;
}

edmill::browser::Session& running() {
  if (!session) throw edmill::InputError("found no run, expected one that has begun");
  return *session;
}

/// The page shows what is searched while it goes on.
void tell_stage(const std::string& stage) {
  EM_ASM({ postMessage({what : 'stage', stage : UTF8ToString($0)}); }, stage.c_str());
}

/// Those of a case, a wall as -1 - its number.
struct FirstImpacts : edmill::Observer<double> {
  explicit FirstImpacts(int most) : most(static_cast<std::size_t>(most)) {}
  void on_impact(const edmill::Impact<double>& impact, edmill::Run<double>& run) override {
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
    session = std::make_unique<edmill::browser::Session>(case_text(), settings(), log != 0);
    session->scene(json);
  });
}

/// To a time [s], or for a negative one by one impact.
EMSCRIPTEN_KEEPALIVE const char* edmill_advance(double time) {
  return answer([&](JsonText& json) {
    if (time < 0)
      running().advance_one_impact();
    else
      running().advance_to(time);
    session->frame(json);
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
    edmill::Run<double> run(
        edmill::CaseAccess::make(edmill::casefile::parse_case(case_text(), "case.toml", settings())));
    FirstImpacts found(most);
    run.attach(found);
    run.finish();
    json.add("time", found.times);
    json.add("ball", found.balls);
    json.add("partner", found.partners);
  });
}

/// The log is the file /log.
/// @param identify  whether the mistake behind violations is looked for
EMSCRIPTEN_KEEPALIVE const char* edmill_audit(int identify) {
  return answer([&](JsonText& json) {
    const auto spec = edmill::casefile::parse_case(case_text(), "case.toml", settings());
    auto options = edmill::audit::options_of(spec);
    options.log = "/log";
    const auto built = edmill::casefile::build_case<double>(spec);
    auto audited = edmill::audit::audit(built.the_case, built.states, options);
    audited.case_name = spec.file;
    audited.log_name = "log";
    json.add("verdict", edmill::audit::name_of(audited.verdict));
    std::string table = edmill::audit::table(audited);
    if (audited.verdict == edmill::audit::AuditVerdict::violations)
      table += edmill::identify::table(edmill::identify::identify(
          spec, options, identify != 0 ? edmill::identify::Search::all : edmill::identify::Search::single,
          tell_stage));
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
      throw edmill::InputError(
          "found a line that is not JSON, expected a file of `edmill prove --certificate`");
    }
  });
}

/// The logs are the files /reference and /log.
EMSCRIPTEN_KEEPALIVE const char* edmill_compare() {
  return answer([&](JsonText& json) {
    edmill::compare::ComparisonOptions options;
    options.a = "/reference";
    options.b = "/log";
    const auto comparison = edmill::compare::compare(options);
    json.add("verdict", edmill::compare::name_of(comparison.verdict));
    json.add("table", edmill::compare::table(comparison));
  });
}
}
