#include "dem/contact_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "base/errors.hpp"
#include "casefile/build_case.hpp"
#include "dem/contact_audit.hpp"
#include "io/csv_reader.hpp"

namespace edmill::dem {

namespace {

/// Columns under Lethe's names, but for those of vectors.
constexpr const char* id_column = "particle_id";
constexpr const char* boundary_column = "boundary_id";
constexpr const char* begin_column = "start_time";
constexpr const char* end_column = "end_time";

struct Listed {
  int ball = 0, boundary = 0;
  double begin = 0, end = 0;
  BallState before, after;  ///< without places
  std::optional<double> mass, diameter;
};

using Places = std::array<std::size_t, 3>;

/// The columns of a vector: start_particle_velocity_x and so on.
Places vector_columns(io::CsvReader& csv, const std::string& when, const std::string& what) {
  Places places{};
  for (std::size_t k = 0; k < 3; ++k)
    places[k] = csv.needed_column(fmt::format("{}_particle_{}_{}", when, what, "xyz"[k])).value_or(0);
  return places;
}

void take(io::CsvReader& csv, const Places& places, Vector& vector) {
  for (std::size_t k = 0; k < 3; ++k)
    if (const auto value = csv.finite(places[k])) vector[static_cast<Eigen::Index>(k)] = *value;
}

std::vector<Listed> read(const std::string& file) {
  io::CsvReader csv(file, "a list of contacts");
  const auto id = csv.needed_column(id_column), boundary = csv.needed_column(boundary_column),
             begin = csv.needed_column(begin_column), end = csv.needed_column(end_column);
  const auto mass = csv.column("mass"), diameter = csv.column("diameter");
  const auto v_before = vector_columns(csv, "start", "velocity"),
             v_after = vector_columns(csv, "end", "velocity"),
             w_before = vector_columns(csv, "start", "angular_velocity"),
             w_after = vector_columns(csv, "end", "angular_velocity");
  csv.throw_problems();
  constexpr int most = std::numeric_limits<int>::max();
  std::vector<Listed> list;
  while (csv.next_row()) {
    Listed c;
    c.ball = csv.whole(*id, "the number of a ball", 0, most).value_or(0);
    c.boundary = csv.whole(*boundary, "the number of a wall", 0, most).value_or(0);
    c.begin = csv.finite(*begin).value_or(0), c.end = csv.finite(*end).value_or(0);
    if (c.end < c.begin) csv.bad_field(*end, "a time after the begin of the contact");
    take(csv, v_before, c.before.velocity), take(csv, v_after, c.after.velocity);
    take(csv, w_before, c.before.spin), take(csv, w_after, c.after.spin);
    if (mass) c.mass = csv.finite(*mass);
    if (diameter) c.diameter = csv.finite(*diameter);
    list.push_back(c);
  }
  csv.throw_problems();
  std::stable_sort(list.begin(), list.end(), [](const Listed& a, const Listed& b) { return a.end < b.end; });
  return list;
}

/// Numbers from 0 on, whatever the first ball's is: all of them occur, or they are counted from 0 or 1.
void number_balls(const std::string& file, std::size_t balls, std::vector<Listed>& list) {
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
    const Vector middle{0, 0, 0}, beside{1e-4, 2e-4, -1.5e-4};
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
    const Vector middle{0, 0, 0};
    return dot<double>(Vector(state.velocity - vessel_.wall_velocity(pose, middle)),
                       vessel_.normal(pose, 0, wall, middle));
  }
  /// A place at which a ball touches a wall.
  Vector touching(double time, std::size_t ball, int wall) const {
    const auto pose = vessel_.at(time);
    const Vector middle{0, 0, 0};
    return -vessel_.normal(pose, ball, wall, middle) * vessel_.gap(pose, ball, wall, middle);
  }

 private:
  const MovingVessel& vessel_;
};

/// The wall of the case for each boundary: the one that its contacts approach and leave.
std::map<int, int> walls_of(const std::vector<Listed>& list, const FlatWalls& walls, int count,
                            const std::string& file) {
  std::map<int, std::vector<const Listed*>> by_boundary;
  for (const auto& c : list) by_boundary[c.boundary].push_back(&c);
  std::map<int, int> found;
  for (const auto& [boundary, contacts] : by_boundary) {
    std::size_t best = 0;
    for (int wall = 0; wall < count; ++wall) {
      const auto hits =
          static_cast<std::size_t>(std::count_if(contacts.begin(), contacts.end(), [&](const Listed* c) {
            return walls.away(c->begin, c->before, wall) < 0 && walls.away(c->end, c->after, wall) > 0;
          }));
      if (hits > best) best = hits, found[boundary] = wall;
    }
    if (10 * best < 9 * contacts.size() || best == 0)
      throw InputError(fmt::format(
          "{}: boundary_id {}: found {} contacts of which at most {} approach and leave one wall of the "
          "case, expected nearly all",
          file, boundary, contacts.size(), best));
  }
  return found;
}

double factor_of(const std::vector<Listed>& list, const auto& said, const auto& expected) {
  std::vector<double> factors;
  for (const auto& c : list)
    if (const std::optional<double> value = said(c)) factors.push_back(*value / expected(c));
  const double factor = factors.empty() ? 1 : median_of(std::move(factors)).value;
  return std::abs(factor - 1) < 1e-5 ? 1 : factor;  // as lists write numbers
}

/// Contacts of a ball that overlap in time are a group; long ones rest.
ContactClass class_of(const std::vector<Listed>& list, std::size_t k, double usual) {
  const auto& c = list[k];
  const auto overlaps = [&](const Listed& other) {
    return &other != &c && other.ball == c.ball && other.begin < c.end && c.begin < other.end;
  };
  for (std::size_t j = k; j-- > 0 && list[j].end > c.begin;)
    if (overlaps(list[j])) return ContactClass::several;
  for (std::size_t j = k + 1; j < list.size() && list[j].end < c.end + 10 * usual; ++j)
    if (overlaps(list[j])) return ContactClass::several;
  return c.end - c.begin > 3 * usual ? ContactClass::lasting : ContactClass::wall;
}

Contact contact_of(const Listed& c, const MovingVessel& vessel, const FlatWalls& walls, int wall) {
  const auto ball = static_cast<std::size_t>(c.ball);
  Contact contact;
  contact.begin = contact.free_until = c.begin, contact.end = contact.free_from = c.end;
  contact.ball = c.ball, contact.partner = wall;
  contact.before = c.before, contact.after = c.after;
  contact.before.position = walls.touching(c.begin, ball, wall);
  contact.after.position = walls.touching(c.end, ball, wall);
  contact.dose = vessel.energy(vessel.at(c.begin), ball, contact.before) -
                 vessel.energy(vessel.at(c.end), ball, contact.after);
  return contact;
}

}  // namespace

bool is_contact_list(const std::string& file) {
  if (io::is_stream(file) || !io::is_readable(file)) return false;
  io::InputFile in(file, "a dump or a list of contacts");
  std::string line;
  while (std::getline(in, line) && line.starts_with("#")) {
  }
  return line.find(boundary_column) != std::string::npos && line.find(begin_column) != std::string::npos &&
         line.find(end_column) != std::string::npos;
}

Imported import_contact_list(const casefile::CaseSpec& spec, const ImportOptions& options,
                             ContactLogWriter& log) {
  const auto built = casefile::build_case<double>(spec);
  const auto& balls = built.the_case.balls;
  const MovingVessel vessel(built.the_case.mill, balls);
  const FlatWalls walls(vessel, options.dump);
  auto list = read(options.dump);
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
  const auto ball_of = [&](const Listed& c) -> const auto& {
    return balls[static_cast<std::size_t>(c.ball)];
  };
  facts.mass_factor = factor_of(
      list, [](const Listed& c) { return c.mass; }, [&](const Listed& c) { return ball_of(c).mass; });
  facts.radius_factor = factor_of(
      list, [](const Listed& c) { return c.diameter; },
      [&](const Listed& c) { return 2 * ball_of(c).radius; });
  facts.first = list.front().begin, facts.last = list.back().end;
  for (std::size_t k = 0; k < list.size(); ++k) {
    auto contact = contact_of(list[k], vessel, walls, wall_of.at(list[k].boundary));
    contact.kind = class_of(list, k, facts.statistics.contact_time);
    facts.first = std::min(facts.first, contact.begin);
    const auto kind = static_cast<std::size_t>(contact.kind);
    ++facts.contacts, ++result.counts[kind];
    facts.doses[kind] += contact.dose;
    log.add(contact);
  }
  return result;
}

}  // namespace edmill::dem
