#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <utility>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "io/csv_reader.hpp"
#include "io/json_file.hpp"
#include "model/parts/partners.hpp"
#include "model/variables.hpp"
#include "report/embedded.hpp"
#include "report/report_page.hpp"
#include "report/sections.hpp"

namespace edmill::report {

namespace {

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

/// Order of magnitude of the largest dissipation in an impact [log10 J]: the heaviest ball at three
/// times the peak speed of the vessel's centre, at that of its walls, and after a fall through it.
double largest_energy(const casefile::CaseSpec& spec) {
  const auto mill = casefile::build_mill<double>(spec);
  const double extent = mill.vessel.extent(), centre = 3 * mill.motion.wall_speed(0),
               walls = mill.motion.wall_speed(extent);
  const double square = centre * centre + walls * walls + 4 * norm<double>(mill.gravity) * extent;
  double heaviest = 0;
  spec.for_each_ball([&](const casefile::BallSpec& ball) {
    heaviest =
        std::max(heaviest, ball.density.to<double>() * std::pow(ball.diameter.to<double>(), 3) / 2);
  });
  return std::log10(heaviest * square);
}

/// Spectra of energy from 1e-9 to 1 J, or nine decades below the most in very small or large mills.
std::string energy_spectra(const casefile::CaseSpec& spec) {
  const double most = largest_energy(spec);
  const int top =
      std::isfinite(most) && (most < -6 || most > 0) ? static_cast<int>(std::ceil(most)) : 0;
  return fmt::format(
      "\n[[output]]\ntype = \"spectra\"\nfolder = \"report\"\nfile = \"spectra_energy.csv\"\n"
      "low = \"1e{} J\"\nhigh = \"1e{} J\"\n",
      top - 9, top);
}

std::string outputs_for(const casefile::CaseSpec& spec) {
  const auto partners = casefile::partners_of(spec);
  std::string text = std::string(outputs_toml) + energy_spectra(spec);
  for (int wall = 0; wall < partners.walls(); ++wall)
    text +=
        partner_trends(partners[wall].key, fmt::format("ball_ball = false, partner = {}", wall));
  return text + partner_trends(partners[partners.ball_ball()].key, "ball_ball = true");
}

/// Number of walls for which a summary has counts of impacts.
int walls_of(const io::Facts& summary) {
  int walls = 0;
  while (summary.has("collisions/" + model::partner_key(walls, walls + 1))) ++walls;
  return walls;
}

/// Duration of a table by its first line, "# from 0.5 s to 10 s: ..."; 0 without such a line [s].
double duration_of(const std::string& file) {
  std::ifstream in(file);
  std::string line;
  double from = 0, until = 0;
  std::getline(in, line);
  return std::sscanf(line.c_str(), "# from %lf s to %lf s", &from, &until) == 2 ? until - from : 0;
}

/// Drops a last interval that is shorter than the first: its rate has another variance.
Series whole(Series s) {
  if (s.size() > 1 &&
      s.back().end - s.back().begin < (1 - 1e-6) * (s.front().end - s.front().begin))
    s.pop_back();
  return s;
}

/// Whether an output contains the impacts with one partner; with any for -1.
bool records(const casefile::OutputSpec& output, const model::Partners& partners, int partner) {
  const int ball_ball = *model::find_variable("ball_ball"), id = *model::find_variable("partner");
  std::vector<casefile::Restriction> expected;
  if (partner == partners.ball_ball())
    expected = {{ball_ball, 1}};
  else if (partner >= 0)
    expected = {{ball_ball, 0}, {id, static_cast<std::uint64_t>(partner)}};
  return std::ranges::is_permutation(output.only, expected,
      [](const auto& a, const auto& b) { return a.variable == b.variable && a.value == b.value; });
}

/// The partners, with top and bottom in the labels, "cap -y (bottom)", for walls named by an axis
/// of the vessel that is along gravity on average over the motion.
model::Partners with_top_and_bottom(const casefile::CaseSpec& spec) {
  const auto mill = casefile::build_mill<double>(spec);
  const double gravity = norm<double>(mill.gravity), period = mill.motion.period();
  auto infos = mill.walls();
  for (int id = 0; id < mill.vessel.wall_count(); ++id) {
    auto& wall = infos[static_cast<std::size_t>(id)];
    const auto& label = wall.label;
    const int axis = label.size() < 2 ? -1 : label.back() - 'x';
    const char sign = label.size() < 2 ? ' ' : label[label.size() - 2];
    if (gravity == 0 || axis < 0 || axis > 2 || (sign != '-' && sign != '+')) continue;
    Vec3<double> outward = Vec3<double>::Zero();
    outward[axis] = sign == '-' ? -1 : 1;
    // Spread over many drive periods: other joints may turn more slowly.
    constexpr int samples = 512, apart = 7;
    constexpr double golden = 0.6180339887498949;
    double along = 0;
    for (int k = 0; k < samples; ++k) {
      const double share = k * golden - std::floor(k * golden);
      const auto pose = mill.motion.pose(Instant<double>{k * apart, period * share});
      along += dot<double>(mill.motion.direction_to_inertial(pose, outward), mill.gravity) /
          gravity / samples;
    }
    if (std::abs(along) > 0.9) wall.label += along > 0 ? " (bottom)" : " (top)";
  }
  return model::Partners(infos);
}

}  // namespace

std::optional<RateOf> rate_in(const io::Facts& summary, const std::string& path) {
  const auto rate = summary.find(path);
  return rate ? std::optional(RateOf{*rate, summary.find("intervals/" + path)}) : std::nullopt;
}

RunFolder read_run_folder(const std::filesystem::path& place) {
  const auto file = place / "summary.json";
  for (const auto* page : {"sweep.html", "optimize.html", "seeds.html"})
    if (!std::filesystem::exists(file) && std::filesystem::exists(place / page))
      throw InputError(fmt::format(
          "{}: found the folder of several runs, expected that of one run; their page is {}",
          place.string(), (place / page).string()));
  RunFolder folder{
      place, io::facts_in(io::read_json(file, "the summary of a run"), file.string()), {}, {}};
  const auto& facts = folder.facts;
  const bool reported = facts.flag("reported");
  folder.spec = casefile::read_case_of_run(
      (place / "case.toml").string(), facts.texts("settings"), facts.text("case_digest"));
  folder.partners = with_top_and_bottom(folder.spec);
  if (const auto found = walls_of(facts), expected = folder.partners.walls(); found != expected)
    throw InputError(fmt::format("{}: collisions: found {} walls, expected the {} of the case",
        file.string(), found, expected));
  if (reported) add_report_outputs(folder.spec);
  return folder;
}

const casefile::OutputSpec* RunFolder::output(std::string_view type, const Fits& fits) const {
  const auto is_written = [&](const casefile::OutputSpec& output) {
    std::error_code ignored;
    const auto file = file_of(output);
    // The file of a record that never began is empty.
    return std::filesystem::is_regular_file(file, ignored) &&
        std::filesystem::file_size(file, ignored) > 0;
  };
  // The report's own outputs come last, and are certain to fit.
  for (auto output = spec.outputs.rbegin(); output != spec.outputs.rend(); ++output)
    if (output->type == type && !output->append && output->timer.on &&
        !output->file.ends_with(".h5") && is_written(*output) && fits(*output))
      return &*output;
  return nullptr;
}

std::optional<OutputTable> RunFolder::table(
    std::string_view type, const std::string& expected, std::size_t texts, const Fits& fits) const {
  const auto* found = output(type, fits);
  return found ? std::optional(read_table(file_of(*found), expected, texts)) : std::nullopt;
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

std::size_t OutputTable::column(std::string_view name) const {
  const std::size_t text_columns = texts.empty() ? 0 : texts.front().size();
  for (std::size_t k = text_columns; k < header.size(); ++k)
    if (header[k] == name || header[k].starts_with(std::string(name) + " ["))
      return k - text_columns;
  throw InputError(file + ": the header has no column '" + std::string(name) + "'");
}

std::vector<std::vector<double>> OutputTable::rows_of(std::string_view text) const {
  std::vector<std::vector<double>> rows;
  for (std::size_t k = 0; k < numbers.size(); ++k)
    if (texts[k].front() == text) rows.push_back(numbers[k]);
  return rows;
}

OutputTable read_table(
    const std::filesystem::path& file, const std::string& expected, std::size_t texts) {
  io::CsvReader reader(file, expected);
  OutputTable table;
  table.file = file.string();
  table.header = reader.header();
  table.duration = duration_of(table.file);
  if (table.header.size() <= texts) reader.bad_line("found too few columns, expected " + expected);
  while (reader.next_row()) {
    std::vector<std::string> words;
    std::vector<double> row;
    for (std::size_t k = 0; k < table.header.size(); ++k) {
      if (k < texts)
        words.emplace_back(reader.field(k));
      else if (reader.field(k).empty())
        row.push_back(std::numeric_limits<double>::quiet_NaN());
      else
        row.push_back(reader.number(k).value_or(0));
    }
    table.texts.push_back(std::move(words));
    table.numbers.push_back(std::move(row));
  }
  reader.throw_problems();
  return table;
}

Series intervals_of(const casefile::OutputSpec& output, const OutputTable& table,
    std::size_t column, double start) {
  Series series;
  double begin = start;
  if (output.timer.start_time) begin = std::max(begin, output.timer.start_time->to<double>());
  for (const auto& row : table.numbers)
    series.push_back({std::exchange(begin, row.at(0)), row.at(0), row.at(column)});
  return series;
}

std::optional<std::size_t> place_of_rate(const casefile::OutputSpec& output, int variable) {
  std::size_t place = 1;  // after the time
  for (const auto& column : output.columns)
    for (const auto statistic : column.statistics) {
      if (column.variable == variable && statistic == casefile::Statistic::rate) return place;
      ++place;
    }
  return std::nullopt;
}

std::optional<Series> rate_of(
    const RunFolder& run, const char* variable, std::size_t most, int partner) {
  const int row = *model::find_variable(variable);
  const auto fits = [&](const casefile::OutputSpec& output) {
    return place_of_rate(output, row) && !output.accumulated && !output.timer.start_collision &&
        records(output, run.partners, partner);
  };
  const auto* output = run.output("trends", fits);
  if (!output) return std::nullopt;
  const auto table = read_table(run.file_of(*output), "a table of trends");
  if (table.numbers.empty()) return std::nullopt;
  const double start = run.spec.initial_time.to<double>();
  return coarser(whole(intervals_of(*output, table, *place_of_rate(*output, row), start)), most);
}

Series coarser(const Series& series, std::size_t most) {
  const std::size_t count = series.size(), together = (count + most - 1) / most;
  Series result;
  for (std::size_t first = 0; first < count; first += together) {
    const std::size_t last = std::min(count, first + together) - 1;
    double amount = 0;
    for (std::size_t k = first; k <= last; ++k)
      amount += series[k].rate * (series[k].end - series[k].begin);
    const double begin = series[first].begin, end = series[last].end;
    result.push_back({begin, end, amount / (end - begin)});
  }
  return result;
}

plot::Points points_of(const Series& series) {
  plot::Points points;
  for (const auto& [begin, end, rate] : series) points.emplace_back((begin + end) / 2, rate);
  return points;
}

}  // namespace edmill::report
