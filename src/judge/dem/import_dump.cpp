#include "dem/import_dump.hpp"

#include <fmt/format.h>

#include <set>
#include <sstream>

#include "base/errors.hpp"
#include "io/output_folder.hpp"

namespace edmill::dem {

namespace {

using Properties = model::BallProperties<double>;

/// The ratio of a dump's value to the case's farthest from 1, but for rounding; 0 if it has none.
double factor_of(const std::vector<double>& dump, const std::vector<Properties>& balls,
    double Properties::*own) {
  if (dump.empty()) return 0;
  double factor = dump[0] / (balls[0].*own);
  for (std::size_t k = 1; k < dump.size(); ++k)
    if (const double ratio = dump[k] / (balls[k].*own); std::abs(factor - 1) < std::abs(ratio - 1))
      factor = ratio;
  return std::abs(factor - 1) < 1e-5 ? 1 : factor;
}

/// Number of frames from which the statistics are taken that are used for all frames.
constexpr std::size_t first_frames = 4000;

}  // namespace

Imported import_dump(const CaseSpec& spec, const ImportOptions& options) {
  io::NamedFile file(options.log);
  const auto built = casefile::build_case<double>(spec);
  const auto& balls = built.the_case.balls;
  DumpFormat format{options.time_step, options.units.value_or("si")};
  bool in_vessel = options.in_vessel;
  int facets = 0;
  if (!options.deck.empty()) {
    const auto facts = facts_of_deck(options.deck);
    if (!format.time_step && !facts.no_time_step.empty()) throw InputError(facts.no_time_step);
    if (!format.time_step) format.time_step = facts.time_step;
    if (facts.units && !options.units) format.units = *facts.units;
    in_vessel = in_vessel || facts.in_vessel;
    facets = facts.facets;
  }
  const MovingVessel vessel(built.the_case.mill, balls, facets);
  FrameReader reader(options.dump, format, balls.size());
  // A deck counts its time from the start of the case.
  const double begin = DriveClock<double>(built.the_case.mill.motion.period()).seconds(built.start);
  const auto next = [&](Frame& frame) {
    if (!reader.next(frame)) return false;
    frame.time += begin;
    for (auto& ball : frame.balls) {
      ball.position = options.axes.of(ball.position) + options.origin;
      ball.velocity = options.axes.of(ball.velocity);
      ball.spin = options.axes.of(ball.spin) * options.axes.handedness();  // reversed in a mirror
    }
    if (in_vessel) {
      const auto pose = vessel.at(frame.time);
      for (auto& ball : frame.balls) ball = vessel.inertial(pose, ball);
    }
    return true;
  };
  std::vector<Frame> head;
  for (Frame frame; head.size() < first_frames && next(frame);) head.push_back(frame);
  if (head.size() < 3)
    throw InputError(
        fmt::format("{}: found {} frames, expected at least 3", options.dump, head.size()));
  Imported result{.log = options.log};
  auto& facts = result.facts;
  facts.dump = options.dump;
  facts.facets = facets;
  facts.statistics = statistics_of(head, built.the_case.mill.gravity);
  facts.mass_factor = factor_of(reader.masses(), balls, &Properties::mass);
  facts.radius_factor = factor_of(reader.radii(), balls, &Properties::radius);
  ContactLogWriter log;
  ContactFinder finder(vessel, facts.statistics, [&](const Contact& contact) {
    result.count(contact);
    log.add(contact);
  });
  facts.first = head.front().time;
  const auto take = [&](Frame frame) {
    facts.last = frame.time;
    if (++facts.frames % 1024 == 0 && options.progress)
      options.progress(frame.time, facts.contacts);
    finder.add(std::move(frame));
  };
  for (auto& frame : head) take(std::move(frame));
  for (Frame frame; next(frame);) {
    take(frame);
    result.interrupted = options.interrupt && *options.interrupt;
    if (result.interrupted) break;
  }
  finder.finish();
  file.write([&](std::ostream& out) { log.write(out, facts); });
  return result;
}

identify::Axes axes_from(const std::string& text) {
  identify::Axes axes;
  std::istringstream in(text);
  std::string word, seen;
  for (std::size_t k = 0; k < 3 && in >> word; ++k) {
    axes.sign[k] = word[0] == '-' ? -1 : 1;
    axes.from[k] = word.back() - 'x';
    if (word.size() == (word[0] == '-' ? 2 : 1)) seen += word.back();
  }
  std::sort(seen.begin(), seen.end());
  if (seen != "xyz" || in >> word)
    throw InputError(fmt::format(
        "--axes: found {}, expected x, y and z in some order, each with or without a -: \"x z -y\"",
        io::in_quotes(text)));
  return axes;
}

std::string table(const Imported& r) {
  const auto& f = r.facts;
  return fmt::format(
      "{}: {} frames, {:.3g} s apart, {:g} s to {:g} s{}\n{} contacts, to {}\n\n{}\n"
      "  milling dose, by the balance of energy: {:.6g} J, {:.4g} W\n",
      f.dump, f.frames, f.statistics.interval, f.first, f.last,
      r.interrupted ? " (interrupted)" : "", f.contacts, r.log, class_table(f.doses, r.counts),
      f.dose(), f.duration() > 0 ? f.dose() / f.duration() : 0);
}

}  // namespace edmill::dem
