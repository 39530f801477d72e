// One run of a case with its totals batch by batch, as JSON: what regression/ward/statistics.py
// averages.
#include <CLI/CLI.hpp>
#include <iostream>

#include "../../tests/support/simulated.hpp"
#include "base/errors.hpp"
#include "base/version.hpp"
#include "casefile/build_case.hpp"
#include "engine/simulation.hpp"
#include "io/json_text.hpp"

namespace {

using namespace edmill;

/// Milling dose [J] and impacts by partner in batches of equal length from the start of statistics
/// on.
class Batches : public engine::Observer<double> {
 public:
  struct Totals {
    double milling_dose = 0;
    std::vector<std::uint64_t> collisions;
  };

  Batches(
      double start, double length, std::size_t count, const DriveClock<double>& clock, int partners)
      : totals_(count, {0, std::vector<std::uint64_t>(partners)}) {
    for (std::size_t k = 0; k <= count; ++k)
      boundaries_.push_back(clock.at(start + static_cast<double>(k) * length));
  }

  void on_impact(const engine::Impact<double>& impact, engine::Simulation<double>&) override {
    while (next_ < boundaries_.size() && boundaries_[next_] < impact.time) ++next_;
    if (next_ == 0 || next_ == boundaries_.size()) return;
    auto& totals = totals_[next_ - 1];
    totals.milling_dose += impact.outcome.milling_dose;
    ++(impact.with_wall ? totals.collisions[impact.partner] : totals.collisions.back());
  }

  const std::vector<Totals>& totals() const { return totals_; }
 private:
  std::vector<Instant<double>> boundaries_;
  std::vector<Totals> totals_;
  std::size_t next_ = 0;
};

/// Lists of numbers, which io::JsonText does not know, are written as texts of numbers.
template <class Value> std::string list(const std::vector<Batches::Totals>& totals, Value value) {
  std::string text;
  for (const auto& t : totals) text += (text.empty() ? "" : " ") + value(t);
  return text;
}

void write(
    const io::Summary<double>& s, double length, const std::vector<Batches::Totals>& totals) {
  io::JsonText json;
  json.add("format", "edmill ward run 1");
  json.add("commit", s.provenance.commit);
  json.add("compiler", s.provenance.compiler);
  json.add("case_digest", s.provenance.case_digest);
  json.add("seed", s.provenance.seed);
  json.add("end_reason", model::name(s.end_reason));
  json.add("start_time", s.start_time);
  json.add("end_time", s.end_time);
  json.add("batch_length", length);
  json.add("milling_dose", s.milling_dose);
  json.add("energy_closure", s.energy_closure);
  json.add("touched_milling_dose", s.touched_dose);
  json.add("touched_impacts", s.touched_impacts);
  json.add("impacts_since_start", s.total_impacts);
  json.add("cpu_seconds", s.cpu_seconds);
  json.begin("batches");
  json.add(
      "milling_dose", list(totals, [](const auto& t) { return to_text<double>(t.milling_dose); }));
  for (int k = 0; k < s.partners.count(); ++k)
    json.add(s.partners[k].key,
        list(totals, [k](const auto& t) { return std::to_string(t.collisions[k]); }));
  json.end();
  std::cout << json.finish();
}

int run_in_batches(
    const std::string& file, const std::vector<std::string>& overrides, double length) {
  const auto spec = casefile::read_case(file, overrides);
  const auto built = casefile::build_case<double>(spec);
  const auto& the_case = built.the_case;
  if (!the_case.stop.end_time)
    throw InputError({file + ": run.end_time: not given, expected a time"});
  const DriveClock<double> clock(the_case.mill.motion.period());
  const double seconds = clock.elapsed(the_case.statistics_start, *the_case.stop.end_time);
  const auto count = static_cast<std::size_t>(seconds / length + 1e-9);
  Batches batches(clock.seconds(the_case.statistics_start), length, count, clock,
      model::partners_of(the_case.mill.vessel).count());
  const auto summary = simulated(spec, built, &batches);
  write(summary, length, batches.totals());
  return summary.end_reason == model::EndReason::end_time ? 0 : 3;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"a run of a case with its totals batch by batch, as JSON on standard output"};
  app.set_version_flag("--version", version() + " " + commit());
  std::string file;
  std::vector<std::string> overrides;
  double length = 2;
  app.add_option("case", file, "case file (TOML)")->required();
  app.add_option("--batch", length, "length of a batch in s")->check(CLI::PositiveNumber);
  app.add_option("--set", overrides, "section.key=value, over the case file")
      ->take_all()
      ->expected(1);
  CLI11_PARSE(app, argc, argv);
  try {
    return run_in_batches(file, overrides, length);
  } catch (const InputError& error) {
    for (const auto& problem : error.problems()) std::cerr << "ward_batches: " << problem << '\n';
    return 2;
  } catch (const std::exception& error) {
    std::cerr << "ward_batches: " << error.what() << '\n';
    return 1;
  }
}
