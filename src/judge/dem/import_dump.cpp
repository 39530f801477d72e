#include "dem/import_dump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <sstream>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "dem/contacts.hpp"
#include "dem/statistics.hpp"

namespace edmill::dem {

namespace {

/// Frames from which the statistics of all are taken.
constexpr std::size_t first_frames = 4000;

/// What the dump says over what the case says, of each ball; empty where it says nothing.
std::vector<double> ratios_of(std::vector<double> dump,
                              const std::vector<model::BallProperties<double>>& balls,
                              double model::BallProperties<double>::*own) {
  for (std::size_t k = 0; k < dump.size(); ++k) dump[k] /= balls[k].*own;
  return dump;
}

/// From the axes of a dump to those of the case. A spin keeps its sense in a mirror.
void put_in_axes(BallState& ball, const identify::Axes& axes) {
  ball.position = axes.of(ball.position);
  ball.velocity = axes.of(ball.velocity);
  ball.spin = axes.of(ball.spin) * axes.handedness();
}

/// Numbers from 0 on, whatever the first ball's is: all of them occur, or they are counted from 0 or 1.
void number_balls(const std::string& file, std::size_t balls, std::vector<ListedContact>& list) {
  std::set<int> ids;
  for (const auto& c : list) ids.insert(c.ball);
  const auto count = static_cast<int>(balls);
  const int first = static_cast<int>(ids.size()) == count ? *ids.begin() : *ids.rbegin() < count ? 0 : 1;
  if (*ids.rbegin() - first >= count)
    throw InputError(fmt::format("{}: found the balls {} to {}, expected {} balls as in the case", file,
                                 *ids.begin(), *ids.rbegin(), balls));
  for (auto& c : list) c.ball -= first;
}

/// The walls of a case as seen from its middle: velocity and normal at any time.
class FlatWalls {
 public:
  FlatWalls(const MovingVessel& vessel, const std::string& file) : vessel_(vessel) {
    // Walls that turn or are round have other velocities and normals at other places.
    const Vector beside{1e-4, 2e-4, -1.5e-4};
    for (const double time : {0.0, 0.00123, 0.0345}) {
      const auto pose = vessel.at(time);
      const Vector turned = vessel.wall_velocity(pose, middle) - vessel.wall_velocity(pose, beside);
      bool flat = norm<double>(turned) < 1e-12;
      for (int wall = 0; wall < vessel.walls(); ++wall) {
        const Vector bent = vessel.normal(pose, 0, wall, middle) - vessel.normal(pose, 0, wall, beside);
        flat = flat && norm<double>(bent) < 1e-12;
      }
      if (!flat)
        throw InputError(
            file +
            ": found a list of contacts without places, expected a case whose walls are flat and do not "
            "turn, or frames of the balls");
    }
  }

  /// Speed of a ball away from a wall [m/s].
  double away(double time, const BallState& state, int wall) const {
    const auto pose = vessel_.at(time);
    return dot<double>(Vector(state.velocity - vessel_.wall_velocity(pose, middle)),
                       vessel_.normal(pose, 0, wall, middle));
  }
  /// A place at which a ball touches a wall.
  Vector touching(double time, std::size_t ball, int wall) const {
    const auto pose = vessel_.at(time);
    return -vessel_.normal(pose, ball, wall, middle) * vessel_.gap(pose, ball, wall, middle);
  }

 private:
  const MovingVessel& vessel_;
  const Vector middle{0, 0, 0};
};

/// The wall of the case for each boundary: the one that its contacts approach and leave.
std::map<int, int> walls_of(const std::vector<ListedContact>& list, const FlatWalls& walls, int count,
                            const std::string& file) {
  std::map<int, std::vector<const ListedContact*>> by_boundary;
  for (const auto& c : list) by_boundary[c.boundary].push_back(&c);
  std::map<int, int> found;
  for (const auto& [boundary, contacts] : by_boundary) {
    std::size_t best = 0;
    for (int wall = 0; wall < count; ++wall) {
      const auto hits = static_cast<std::size_t>(
          std::count_if(contacts.begin(), contacts.end(), [&](const ListedContact* c) {
            return walls.away(c->begin, c->before, wall) < 0 && walls.away(c->end, c->after, wall) > 0;
          }));
      if (hits > best) {
        best = hits;
        found[boundary] = wall;
      }
    }
    if (10 * best < 9 * contacts.size() || best == 0)
      throw InputError(fmt::format(
          "{}: boundary_id {}: found {} contacts of which at most {} approach and leave one wall of the "
          "case, expected nearly all",
          file, boundary, contacts.size(), best));
  }
  return found;
}

/// Contacts of a ball that overlap in time are a group; long ones rest.
ContactClass class_of(const std::vector<ListedContact>& list, std::size_t k, double usual) {
  const auto& c = list[k];
  const auto overlaps = [&](const ListedContact& other) {
    return &other != &c && other.ball == c.ball && other.begin < c.end && c.begin < other.end;
  };
  for (std::size_t j = k; j-- > 0 && list[j].end > c.begin;)
    if (overlaps(list[j])) return ContactClass::several;
  for (std::size_t j = k + 1; j < list.size() && list[j].end < c.end + 10 * usual; ++j)
    if (overlaps(list[j])) return ContactClass::several;
  return c.end - c.begin > 3 * usual ? ContactClass::lasting : ContactClass::wall;
}

/// A list of contacts with walls has no places. Its contacts can be judged where the velocity of a wall and
/// its normal are the same at all places: flat walls that do not turn. The log has no frames, and no contacts
/// between balls.
/// @throws InputError when it cannot be read, lacks what is needed, or the case has other walls
Imported import_contact_list(const casefile::CaseSpec& spec, const ImportOptions& options,
                             ContactLogWriter& log) {
  const auto built = casefile::build_case<double>(spec);
  const auto& balls = built.the_case.balls;
  const MovingVessel vessel(built.the_case.mill, balls);
  const FlatWalls walls(vessel, options.dump);
  auto list = read_contact_list(options.dump);
  for (auto& c : list)
    for (auto* state : {&c.before, &c.after}) put_in_axes(*state, options.axes);
  if (list.empty()) throw InputError(options.dump + ": found no contacts, expected some");
  number_balls(options.dump, balls.size(), list);
  const auto wall_of = walls_of(list, walls, vessel.walls(), options.dump);
  std::vector<double> durations;
  for (const auto& c : list) durations.push_back(c.end - c.begin);
  Imported result;
  auto& facts = result.facts;
  facts.dump = options.dump;
  facts.statistics.contact_time = median_of(std::move(durations)).value;
  facts.statistics.gravity = built.the_case.mill.gravity;  // a list does not show it
  std::vector<double> masses, diameters;
  for (const auto& c : list) {
    const auto& ball = balls[static_cast<std::size_t>(c.ball)];
    if (c.mass) masses.push_back(*c.mass / ball.mass);
    if (c.diameter) diameters.push_back(*c.diameter / (2 * ball.radius));
  }
  facts.mass_factor = factor_of(masses);
  facts.radius_factor = factor_of(diameters);
  facts.first = list.front().begin;
  facts.last = list.back().end;
  for (std::size_t k = 0; k < list.size(); ++k) {
    auto& c = list[k];
    const auto ball = static_cast<std::size_t>(c.ball);
    c.kind = class_of(list, k, facts.statistics.contact_time);
    c.free_until = c.begin;
    c.free_from = c.end;
    c.partner = wall_of.at(c.boundary);
    c.before.position = walls.touching(c.begin, ball, c.partner);
    c.after.position = walls.touching(c.end, ball, c.partner);
    c.dose =
        vessel.energy(vessel.at(c.begin), ball, c.before) - vessel.energy(vessel.at(c.end), ball, c.after);
    facts.first = std::min(facts.first, c.begin);
    result.count(c);
    log.add(c);
  }
  return result;
}

}  // namespace

Imported import_dump(const casefile::CaseSpec& spec, const ImportOptions& options, ContactLogWriter& log) {
  if (is_contact_list(options.dump)) return import_contact_list(spec, options, log);
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
      put_in_axes(ball, options.axes);
      ball.position += options.origin;
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
    throw InputError(fmt::format("{}: found {} frames, expected at least 3", options.dump, head.size()));
  Imported result;
  auto& facts = result.facts;
  facts.dump = options.dump;
  facts.facets = facets;
  facts.statistics = statistics_of(head, built.the_case.mill.gravity);
  facts.mass_factor = factor_of(ratios_of(reader.masses(), balls, &model::BallProperties<double>::mass));
  facts.radius_factor = factor_of(ratios_of(reader.radii(), balls, &model::BallProperties<double>::radius));
  ContactFinder finder(vessel, facts.statistics, [&](const Contact& contact) {
    result.count(contact);
    log.add(contact);
  });
  facts.first = head.front().time;
  const auto take = [&](Frame frame) {
    facts.last = frame.time;
    if (++facts.frames % 1024 == 0 && options.progress) options.progress(frame.time, facts.contacts);
    finder.add(std::move(frame));
  };
  for (auto& frame : head) take(std::move(frame));
  for (Frame frame; next(frame);) {
    take(frame);
    result.interrupted = options.interrupt && *options.interrupt;
    if (result.interrupted) break;
  }
  finder.finish();
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
  std::ranges::sort(seen);
  if (seen != "xyz" || in >> word)
    throw InputError(fmt::format(
        "--axes: found {}, expected x, y and z in some order, each with a - or without: \"x z -y\"",
        io::in_quotes(text)));
  return axes;
}

std::string table(const Imported& r, const std::string& log) {
  const auto& f = r.facts;
  const auto source = f.of_list() ? std::string("a list of contacts with walls")
                                  : fmt::format("{} frames, {:.3g} s apart", f.frames, f.statistics.interval);
  std::string out = fmt::format("{}: {}, {:g} s to {:g} s{}\n{} contacts, to {}\n\n  {:<14}{:>10}{:>13}\n",
                                f.dump, source, f.first, f.last, r.interrupted ? " (interrupted)" : "",
                                f.contacts, log, "contacts", "number", "of the dose");
  for (std::size_t k = 0; k < contact_class_names.size(); ++k)
    out += fmt::format("  {:<14}{:>10}{:>12.2f}%\n", contact_class_names[k], r.counts[k],
                       f.dose() != 0 ? 100 * f.doses[k] / f.dose() : 0);
  return out + fmt::format("\n  milling dose, by the balance of energy: {:.6g} J, {:.4g} W\n", f.dose(),
                           f.duration() > 0 ? f.dose() / f.duration() : 0);
}

}  // namespace edmill::dem
