
#include <fmt/format.h>

#include "base/errors.hpp"
#include "decks/soft_contact.hpp"
#include "dem/contact_rates.hpp"
#include "identify/assumed.hpp"

namespace edmill::dem {

namespace {

struct Measured {
  std::vector<std::string> parts;  ///< groups that include it: "at cap -y", "of balls.1 at walls"
  double dose = 0;                 ///< [J]
  double approach = 0, slip = 0;   ///< at the touch [m/s]
  double pressed = 0;  ///< relative change of the approach by gravity and walls during the contact
  double turned = 0;   ///< rotation of the normal during the contact [rad]
  double depth = 0;    ///< largest overlap of a Hertz contact of this duration, over the radius
  double slip_left = 0;   ///< slip after the contact, along and relative to that at the touch
  double wall_speed = 0;  ///< along the normal [m/s]
  // Of the case:
  double law_restitution = 0, law_friction = 0;
  // Measured, if the contact determines them:
  std::optional<double> restitution = {};  ///< corrected for `pressed`
  std::optional<double> friction = {};     ///< tangential over normal impulse
  double wound = 0;  ///< least slip for sliding throughout, over the slip of this contact
  std::optional<double> stopping_friction = {};  ///< over the one that just stops the slip
  std::optional<double> spin_change = {};    ///< over that of the impulse, m J R^2 dw = -R n x m dv
  std::optional<double> wall_velocity = {};  ///< factor that gives the case's restitution
};

using MeasuredList = std::vector<Measured>;
using Of = Judged::Of;

/// A value of each contact of a list that is chosen.
std::vector<double> values_of(const MeasuredList& list, const auto& is_chosen, const auto& value) {
  std::vector<double> values;
  for (const auto& measured : list)
    if (is_chosen(measured)) values.push_back(std::invoke(value, measured));
  return values;
}

/// Relative velocity of two surfaces [m/s], along and across the unit normal to the ball.
struct Surfaces {
  Vector normal;
  double separation;
  Vector along;

  Surfaces(const Vector& n, const Vector& velocity)
      : normal(n), separation(dot(velocity, n)), along(velocity - n * separation) {}
};

struct Bodies {
  std::vector<std::string> parts;
  const model::ContactLaw<double>& law;
  const model::BallProperties<double>& ball;
  model::ContactBodies<double> sizes;
  double compliance;  ///< 1 + M/(m_i J_i) + M/(m_j J_j)
};

/// Measures a contact. During it curved walls rotate, the line of centres of a pair turns and
/// gravity presses or separates the bodies; flights extrapolated through it show by how much.
/// @param at  returns the surfaces at a time for states of the ball and its partner
Measured measured_by(const Contact& c, const Vector& gravity, const Bodies& bodies, auto at) {
  const double duration = c.end - c.begin;
  const auto on = [&](const BallState& state) { return flown(state, gravity, duration); };
  const auto back = [&](const BallState& state) { return flown(state, gravity, -duration); };
  const Surfaces touch = at(c.begin, c.before, c.partner_before),
                 leave = at(c.end, c.after, c.partner_after),
                 flown_on = at(c.end, on(c.before), on(c.partner_before)),
                 flown_back = at(c.begin, back(c.after), back(c.partner_after));
  Measured measured{.parts = bodies.parts,
      .dose = c.dose,
      .approach = -touch.separation,
      .slip = norm(touch.along)};
  if (!(measured.approach > 0)) return measured;
  bool has_friction = false;
  measured.law_restitution = bodies.law.restitution(measured.approach, bodies.sizes);
  bodies.law.parameters([&](const model::Parameter& p, double value) {
    if (p.key != std::string("friction")) return;
    has_friction = true;
    measured.law_friction = value;
  });
  // The flights before and after differ in it; friction leads from the first to the second.
  const double first = (touch.separation - flown_on.separation) / (2 * measured.approach),
               last = (flown_back.separation - leave.separation) / (2 * measured.approach),
               early = (3 * first + last) / 4, late = (first + 3 * last) / 4;
  measured.pressed = early + late;
  measured.turned = norm(leave.normal - touch.normal);
  measured.depth = 0.34 * duration * measured.approach / bodies.ball.radius;
  const double separation = leave.separation / measured.approach, e = measured.law_restitution;
  // A force adds to the approach, then brakes; equal ones before and after have press_effect(e).
  measured.restitution = separation + (2 * decks::press_effect(e) + e) * late - e * early;
  const Vector left = leave.along - (flown_on.along - touch.along);
  if (measured.slip > 0)
    measured.slip_left = dot(left, touch.along) / (measured.slip * measured.slip);
  const Vector both = touch.normal + leave.normal, normal = both / norm(both);
  const Vector change = c.after.velocity - c.before.velocity - gravity * duration,
               along = change - normal * dot(change, normal),
               due = cross(normal, along) / (-bodies.ball.reduced_inertia * bodies.ball.radius);
  const double friction = norm(along) / dot(change, normal);
  if (friction > 0.05)
    measured.spin_change = dot(c.after.spin - c.before.spin, due) / dot(due, due);
  if (!has_friction) return measured;
  // Slip above which the case's contact slides throughout.
  const double least = measured.law_friction * bodies.compliance *
      (1 + separation + measured.pressed) * measured.approach;
  measured.wound = least / measured.slip;
  if (measured.slip > least)
    measured.friction = friction;
  else if (measured.slip > 0.3 * least)
    measured.stopping_friction = friction * measured.wound / measured.law_friction;
  return measured;
}

/// Measures the single contacts of a log with the bodies and laws of a case.
class SingleContacts {
 public:
  /// The mill and the vessel must outlive it. @param gravity in which the balls fly [m/s^2]
  SingleContacts(
      const CaseSpec& spec, const Mill& mill, const MovingVessel& vessel, const Vector& gravity)
      : mill_(mill), vessel_(vessel), gravity_(gravity), partners_(casefile::partners_of(spec)) {
    for (const auto& group : identify::ball_groups(spec))
      for (std::size_t k = group.first; k < group.last; ++k) kinds_.push_back(group.key);
  }

  Measured at_wall(const Contact& c) const {
    const auto ball = static_cast<std::size_t>(c.ball);
    const auto& b = vessel_.ball(ball);
    const Bodies bodies{
        parts_of({"at " + partners_[c.partner].label, "of " + kinds_[ball] + " at walls"}, {ball},
            "at walls"),
        mill_.law_with_wall(b, c.partner), b, {b.mass, b.radius}, 1 + 1 / b.reduced_inertia};
    const auto middle = vessel_.at((c.begin + c.end) / 2);
    auto measured = measured_by(c, gravity_, bodies, [&](double time, const auto& i, const auto&) {
      const auto pose = vessel_.at(time);
      const Vector n = vessel_.normal(pose, ball, c.partner, i.position), arm = n * -b.radius;
      return Surfaces(n,
          i.velocity + cross(i.spin, arm) -
              vessel_.wall_velocity(pose, c.partner, i.position + arm));
    });
    measured.wall_speed = dot(vessel_.wall_velocity(middle, c.partner, c.before.position),
        vessel_.normal(middle, ball, c.partner, c.before.position));
    const double change = (1 + measured.law_restitution) * measured.wall_speed;
    if (measured.restitution && std::abs(measured.wall_speed) > 0.3 * measured.approach)
      measured.wall_velocity =
          1 + (*measured.restitution - measured.law_restitution) * measured.approach / change;
    return measured;
  }

  Measured between_balls(const Contact& c) const {
    const auto one = static_cast<std::size_t>(c.ball), two = static_cast<std::size_t>(c.partner);
    const auto &a = vessel_.ball(one), &b = vessel_.ball(two);
    const double effective = a.mass * b.mass / (a.mass + b.mass);
    const auto [low, high] = std::minmax(kinds_[one], kinds_[two]);
    const Bodies bodies{parts_of({"between " + low + " and " + high}, {one, two}, "with balls"),
        mill_.law_between(a, b), a, {effective, a.radius, b.radius},
        1 + effective / (a.mass * a.reduced_inertia) + effective / (b.mass * b.reduced_inertia)};
    return measured_by(c, gravity_, bodies, [&](double, const auto& i, const auto& j) {
      const Vector apart = i.position - j.position, n = apart / norm(apart);
      return Surfaces(n, i.velocity - j.velocity - cross(i.spin * a.radius + j.spin * b.radius, n));
    });
  }
 private:
  /// Adds a group for each ball, if the case has no more than 40.
  std::vector<std::string> parts_of(std::vector<std::string> parts,
      std::initializer_list<std::size_t> balls, const char* where) const {
    constexpr std::size_t most = 40;
    for (const auto ball : balls)
      if (kinds_.size() <= most) parts.push_back(fmt::format("of ball {} {}", ball, where));
    return parts;
  }

  const Mill& mill_;
  const MovingVessel& vessel_;
  Vector gravity_;
  model::Partners partners_;
  std::vector<std::string> kinds_;  ///< entry of the case that defines each ball
};

/// A quantity measured on single contacts, and its expected value in the case.
struct Value {
  const char *name, *equation;
  double allowed, by_pressing, by_turning, by_depth;
  std::optional<double> Measured::*found;
  double due = 1;                         ///< expected for every contact
  double Measured::*law = nullptr;        ///< expected for each contact
  double Measured::*vanishing = nullptr;  ///< the result is extrapolated linearly to 0 of this
};

const Value restitution{"restitution", "(2.23')", 0.003, 0.1, 0, 0, &Measured::restitution, 0,
    &Measured::law_restitution};
/// Measured on contacts that slide throughout. Loading the tangential spring counts by the inverse
/// of the slip.
const Value friction{"friction", "(2.24')", 0.01, 0, 0.1, 0, &Measured::friction, 0,
    &Measured::law_friction, &Measured::wound};
/// Measured on contacts whose slip friction stops. Tangential springs reverse the slip, with up to
/// twice the impulse.
const Value sticking{"stopping friction", "(2.24')", 1, 0, 0, 0, &Measured::stopping_friction, 1.5};
/// In some codes the arm of the torque is shorter by the overlap.
const Value spin_change{
    "spin change over the torque's", "(2.35)", 0.02, 0, 0.3, 1, &Measured::spin_change};
const Value wall_velocity{"velocity", "(2.27)", 0.02, 0.2, 0, 0, &Measured::wall_velocity};

/// Selects the contacts that determine a law best. It rejects gentle ones, and ones with strong
/// forces or a rotating normal: gravity and the motion of the bodies change them too much.
class Clear {
 public:
  explicit Clear(const MeasuredList& list) {
    if (list.empty()) return;
    const auto any = [](const Measured&) { return true; };
    least_approach_ = numerics::quantile(values_of(list, any, &Measured::approach), 0.9) / 8;
    const auto fast = [&](const Measured& s) { return s.approach >= least_approach_; };
    most_ = std::clamp(numerics::quantile(values_of(list, fast, disturbance), 0.5), 0.1, 1.0);
  }

  bool operator()(const Measured& s) const {
    return s.approach >= least_approach_ && disturbance(s) <= most_;
  }
 private:
  static double disturbance(const Measured& s) {
    return std::max(std::abs(s.pressed) / 0.2, s.turned / 0.2);
  }

  double least_approach_ = 0, most_ = 1;
};

/// Half of the interquartile range of the restitution that finite time steps may cause.
constexpr double spread_allowed = 0.007;

/// Judges a value by contacts, each with its own law, which may depend on speed or materials. The
/// result has the median of the laws' values, and this plus the code's deviation.
/// @param number  of values judged together, for the width of the interval
Judged judged(const Value& value, const std::string& where, const MeasuredList& list,
    const Clear& is_clear, double number, double all_dose) {
  Judged j{.name = fmt::format("{} {}", value.name, where),
      .equation = value.equation,
      .allowed = value.allowed};
  for (const auto& s : list)
    if (all_dose > 0 && s.*value.found) j.dose_share += std::abs(s.dose) / all_dose;
  const auto values = [&](const auto& of) {
    return values_of(
        list, [&](const Measured& s) { return s.*value.found && is_clear(s); }, of);
  };
  const auto median = [&](const auto& of) { return median_of(values(of)).value; };
  const auto due = [&](const Measured& s) { return value.law ? s.*value.law : value.due; };
  const auto off = values([&](const Measured& s) { return *(s.*value.found) - due(s); });
  j.spread = (numerics::quantile(off, 0.75) - numerics::quantile(off, 0.25)) / 2;
  j.found = value.vanishing ? numerics::median_at_zero(values(value.vanishing), off, number)
                            : median_of(off, number);
  j.expected = median(due);
  j.allowed += value.by_pressing * median([](const Measured& s) { return std::abs(s.pressed); }) +
      value.by_turning * median(&Measured::turned) + value.by_depth * median(&Measured::depth);
  for (double* end : {&j.found.value, &j.found.low, &j.found.high}) *end += j.expected;
  return j;
}

void judge_laws(const MeasuredList& list, Of of, ContactAudit& audit) {
  if (list.empty()) return;
  std::map<std::string, MeasuredList> parts;
  for (const auto& measured : list)
    for (const auto& part : measured.parts) parts[part].push_back(measured);
  const std::string where = of == Of::walls ? "at walls" : "between balls";
  const std::size_t first = audit.judged.size();
  std::erase_if(parts, [&](const auto& part) { return part.second.size() == list.size(); });
  const Clear is_clear(list);
  const double dose = audit.magnitude, number = static_cast<double>(parts.size() + 2);
  const auto add = [&](const Value& value, const std::string& at, const MeasuredList& some,
                       double alike) {
    auto result = judged(value, at, some, is_clear, alike, dose);
    result.of = of;
    result.is_part = alike > 1;
    // No verdict depends on friction that stops the slip and on values of single balls.
    if (result.dose_share > 0 &&
        (result.found.known() || !(&value == &sticking || at.starts_with("of ball "))))
      audit.judged.push_back(std::move(result));
  };
  for (const auto* value : {&restitution, &friction, &sticking, &spin_change}) {
    add(*value, where, list, 1);
    for (const auto& [part, members] : parts) add(*value, part, members, number);
  }
  auto slow = list;
  std::sort(slow.begin(), slow.end(), [](auto& a, auto& b) { return a.approach < b.approach; });
  const auto fast = slow.end() - static_cast<std::ptrdiff_t>(3 * list.size() / 10);
  add(restitution, "of fast contacts " + where, {fast, slow.end()}, number);
  add(restitution, "of slow contacts " + where, {slow.begin(), fast}, number);
  if (audit.judged.size() == first) return;
  const auto whole = audit.judged[first];  // the restitution of all
  audit.judged.push_back({.name = "spread of the " + whole.name,
      .equation = restitution.equation,
      .found = {whole.spread, whole.spread, whole.spread, whole.found.count},
      .allowed = spread_allowed + 3 * (whole.allowed - restitution.allowed),
      .dose_share = whole.dose_share,
      .of = of});
}

/// Excludes values from judgement that follow from others or have no meaning because of them.
void leave_out(ContactAudit& audit, const std::string& because, const auto& which) {
  for (auto& judged : audit.judged)
    if (which(judged)) judged.not_judged = because;
}

constexpr const char* follows_from_velocity = "it would follow from the velocity of the walls";

/// Distinguishes a wrong wall velocity from a wrong restitution, which look alike: the one that
/// explains more is judged, for all walls together and for each that differs by itself. A velocity
/// that explains a wrong restitution is judged without a tolerance.
void judge_wall_velocity(const MeasuredList& walls, ContactAudit& audit) {
  std::vector<std::string> parts{"at walls"};
  for (const auto& j : audit.judged)
    if (j.name.starts_with("restitution at ") && j.is_part && !j.agrees())
      parts.push_back(j.name.substr(12));
  bool all_follow = false, some_follow = false;  // restitutions
  for (const auto& part : parts) {
    const bool all = &part == &parts[0];
    MeasuredList list;
    std::copy_if(walls.begin(), walls.end(), std::back_inserter(list), [&](const Measured& s) {
      return all || std::count(s.parts.begin(), s.parts.end(), part) > 0;
    });
    const Clear is_clear(list);
    auto velocity =
        judged(wall_velocity, all ? "of the walls over the case's" : "over the case's " + part,
            list, is_clear, static_cast<double>(parts.size()), audit.magnitude);
    const auto e = std::find_if(audit.judged.begin(), audit.judged.end(),
        [&](const auto& j) { return j.name == "restitution " + part; });
    if (!velocity.known() || e == audit.judged.end()) continue;
    const auto is_chosen = [&](const Measured& s) { return s.restitution && is_clear(s); };
    const auto changes = values_of(list, is_chosen,
        [](const Measured& s) { return (*s.restitution - s.law_restitution) * s.approach; });
    const auto left_by = [&](const auto& of) {
      return numerics::mean_left_by(values_of(list, is_chosen, of), changes);
    };
    const double margin = all ? 1 : 1.25;  // one wall has few contacts
    const bool is_velocity = margin * left_by([](const Measured& s) {
      return (1 + s.law_restitution) * s.wall_speed;
    }) < left_by(&Measured::approach);
    if (is_velocity && !e->agrees()) velocity.allowed = 0;
    if (!is_velocity && !(velocity.agrees() && e->agrees()))
      velocity.not_judged = "it would follow from the restitution";
    (all ? all_follow : some_follow) |= is_velocity && !velocity.agrees();
    if (some_follow && !velocity.agrees()) e->not_judged = follows_from_velocity;
    velocity.of = Of::walls;
    velocity.is_part = !all;
    audit.judged.push_back(velocity);
    if (all_follow) break;
  }
  leave_out(audit, follows_from_velocity, [=](const Judged& j) {
    const bool at_wall = j.is_part && j.name.starts_with("restitution at ");
    return j.of == Of::walls &&
        ((all_follow && j.equation != spin_change.equation &&
             j.equation != wall_velocity.equation) ||
            (some_follow && j.equation == restitution.equation && !at_wall));
  });
}

constexpr const char* unexplained_dose = "dose with no wall or ball";

void judge_facts(const Mill& mill, ContactAudit& audit) {
  const auto& facts = audit.facts;
  const auto add = [&](const std::string& name, double found, double half_width, double expected,
                       double allowed, Of of = Of::log, const char* unit = "") {
    audit.judged.push_back({.name = name,
        .unit = unit,
        .found = {found, found - half_width, found + half_width, Median::least},
        .expected = expected,
        .allowed = allowed,
        .of = of});
  };
  for (Eigen::Index k = 0; k < 3; ++k)
    add(fmt::format("gravity along {}", "XYZ"[k]), facts.statistics.gravity[k],
        facts.statistics.gravity_half_width[k], mill.gravity[k], 1e-3 * norm(mill.gravity) + 1e-3,
        Of::log, "m/s^2");
  const double size = facts.radius_factor > 0 ? facts.radius_factor : 1;
  add("density over the case's", facts.mass_factor / (size * size * size), 0, 1, 1e-6);
  add("diameter over the case's", facts.radius_factor, 0, 1, 1e-6);
  leave_out(audit, "the dump does not have it",
      [](const Judged& j) { return j.name.ends_with("the case's") && j.found.value == 0; });
  // A ball that leaves its flight must have met a wall or ball, as far as the frames resolve it.
  if (const double all = facts.dose(); all > 0)
    add(unexplained_dose, facts.doses[static_cast<std::size_t>(ContactClass::unexplained)] / all, 0,
        0, 0.01, Of::walls);
  if (const double factor = facts.statistics.way_factor; factor != 0)  // balls move
    add("displacements over those by velocities", factor, 0, 1, 0.01);
  const auto none = [&](const char* name, std::uint64_t found, Of of) {
    add(name, static_cast<double>(found), 0, 0, 0, of);
  };
  none("contacts missed at walls", audit.missed_at_walls, Of::walls);
  none("contacts missed between balls", audit.missed_between_balls, Of::balls);
  none("jumps of balls", audit.jumps(), Of::log);
}

std::vector<SlipBin> slips_of(const MeasuredList& walls, const MeasuredList& balls) {
  std::vector<SlipBin> bins;
  const Clear of_these_walls(walls), of_these_balls(balls);
  const auto ratio = [](const Measured& s) { return s.slip / s.approach; };
  for (double low = 0; low < 12; low = low < 1 ? low + 0.25 : low * 1.25) {
    const double high = low < 1 ? low + 0.25 : low * 1.25;
    const auto of = [&](const MeasuredList& list, const auto& value) {
      const auto& is_clear = &list == &walls ? of_these_walls : of_these_balls;
      const auto in_bin = [&](const Measured& s) {
        return is_clear(s) && ratio(s) >= low && ratio(s) < high;
      };
      return median_of(values_of(list, in_bin, value));
    };
    SlipBin bin{0, of(walls, &Measured::slip_left), of(balls, &Measured::slip_left)};
    bin.ratio = of(bin.of_walls.count >= bin.of_balls.count ? walls : balls, ratio).value;
    if (bin.of_walls.known() || bin.of_balls.known()) bins.push_back(bin);
  }
  return bins;
}

}  // namespace

bool ContactAudit::wall_velocity_differs() const {
  return std::any_of(judged.begin(), judged.end(),
      [](const Judged& j) { return j.equation == wall_velocity.equation && !j.agrees(); });
}

ContactAudit audit_contacts(
    const CaseSpec& spec, const std::string& file, const std::atomic<bool>* interrupt) {
  ContactLogReader log(file);
  const auto built = casefile::build_case<double>(spec);
  const auto& mill = built.the_case.mill;
  const MovingVessel vessel(mill, built.the_case.balls, log.facts().facets);
  ContactAudit audit;
  audit.case_name = spec.file;
  audit.log_name = file;
  audit.facts = log.facts();
  MeasuredList walls, balls;
  std::vector<Contact> at_walls;
  const SingleContacts contacts(spec, mill, vessel, log.facts().statistics.gravity);
  DoseRate rate(log.facts().first, log.facts().last);
  while (const auto contact = log.next()) {
    if (interrupt && *interrupt) audit.interrupted = true;
    if (audit.interrupted) break;
    const auto& c = *contact;
    const int balls_of_case = static_cast<int>(vessel.ball_count());
    if (c.ball >= balls_of_case || c.partner >= (c.bodies == 1 ? vessel.walls() : balls_of_case))
      throw InputError(fmt::format("{}: found ball {} with {} {}, expected {} balls and {} walls",
          file, c.ball, c.bodies == 1 ? "wall" : "ball", c.partner, balls_of_case, vessel.walls()));
    ++audit.counts[static_cast<std::size_t>(c.kind)];
    rate.add((c.begin + c.end) / 2, c.dose);
    audit.magnitude += std::abs(c.dose);
    if (c.kind == ContactClass::wall) walls.push_back(contacts.at_wall(c));
    if (c.kind == ContactClass::pair) balls.push_back(contacts.between_balls(c));
    if (c.kind == ContactClass::missed)
      ++(c.bodies == 1 ? audit.missed_at_walls : audit.missed_between_balls);
    constexpr std::size_t enough = 400;
    const bool open = c.kind < ContactClass::lasting || c.kind == ContactClass::unexplained;
    if (open && c.bodies == 1 && at_walls.size() < enough) at_walls.push_back(c);
  }
  // Unexplained contacts that overlap in time are of balls that collided.
  std::erase_if(at_walls, [all = at_walls](const Contact& c) {
    return c.kind == ContactClass::unexplained &&
        std::any_of(all.begin(), all.end(), [&](const Contact& other) {
          return other.ball != c.ball && other.kind == c.kind && other.free_until < c.free_from &&
              c.free_until < other.free_from;
        });
  });
  audit.dose_rate = *rate.estimate().mean;
  audit.dose_rate_half_width = *rate.estimate().half_width;
  judge_laws(walls, Of::walls, audit);
  judge_laws(balls, Of::balls, audit);
  judge_wall_velocity(walls, audit);
  for (const auto of : {Of::walls, Of::balls})
    if (std::any_of(audit.judged.begin(), audit.judged.end(), [=](const Judged& j) {
          return j.of == of && j.equation == spin_change.equation && !j.agrees();
        }))
      leave_out(audit, "the spins differ",
          [=](const Judged& j) { return j.of == of && j.equation == friction.equation; });
  judge_facts(mill, audit);
  audit.slips = slips_of(walls, balls);
  // Balls of another size meet the walls elsewhere.
  const double size = audit.facts.radius_factor;
  const bool is_other_size = size != 1 && size != 0;
  if (!is_other_size) judge_places(spec, at_walls, interrupt, audit);
  if (const bool jumps = audit.jumps() > 0; jumps || audit.wall_velocity_differs())
    leave_out(audit, jumps ? "balls jump" : follows_from_velocity,
        [](const Judged& j) { return j.name == unexplained_dose; });
  if (is_other_size || (!audit.causes.empty() && audit.causes[0].key.starts_with("ball")))
    leave_out(audit, "the balls have another size", [](auto& j) { return j.of != Of::log; });
  else if (!audit.walls_met())
    leave_out(audit, "the walls are elsewhere", [](auto& j) { return j.of == Of::walls; });
  const auto is_known = [](const Judged& j) {
    return j.equation == restitution.equation && j.known();
  };
  if (!std::all_of(
          audit.judged.begin(), audit.judged.end(), [](const auto& j) { return j.agrees(); }) ||
      !audit.walls_met())
    audit.verdict = Verdict::differ;
  else if (!audit.interrupted && std::any_of(audit.judged.begin(), audit.judged.end(), is_known) &&
      std::none_of(
          audit.judged.begin(), audit.judged.end(), [](const auto& j) { return j.is_open(); }))
    audit.verdict = Verdict::agree;
  return audit;
}

}  // namespace edmill::dem
