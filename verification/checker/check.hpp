// Checks a certificate of proven events, rule by rule. docs/certificates.md
#pragma once

#include <istream>

#include "mill.hpp"

namespace checker {
/// Position and velocity at the exact time m. Flown after an event of a bracket that begins at `begin`.
struct Flight {
  Real m;
  Vec r, v, s;
  Real begin;
  long event = -1, wall = -1, with = -1;  ///< what it follows
  Vec r_0{}, v_0{};                       ///< of the same parabola at the time 0: in few bits, to compare with others
  Vec position(const Real& t, const Vec& g) const { return r + (v + g * ((t - m) / 2)) * (t - m); }
  Vec velocity(const Real& t, const Vec& g) const { return v + g * (t - m); }
};

class Check {
 public:
  Check(const Json& header, slong bits) : bits_(bits + 64), at_(bits_), mill_(header) {
    const Pose pose = mill_.pose(0);
    for (const auto& ball : mill_.balls) {
      Flight f{0, ball.in_vessel ? pose.C + pose.out(ball.position) : ball.position, ball.velocity, ball.spin, 0};
      for (Vec* v : {&f.r, &f.v, &f.s})
        for (Real& x : *v)
          if (v == &f.r || !x.zero()) arb_add_error_2exp_si(x.x, -bits);
      flights_.push_back(at_zero(f));
    }
    since_.resize(balls(), Real(0)), unmoved_.resize(balls());
  }
  Index balls() const { return flights_.size(); }
  void take(const Json& line) {
    known(line, {"event", "ball", "wall", "partner", "time", "states", "windows"});
    if (line.value("event", Json()) != events_) reject("rule 6: its number is not the next");
    const bool on_wall = line.contains("wall");
    const Index i = index(line.at("ball"), balls());
    const Index j = index(line.at(on_wall ? "wall" : "partner"), on_wall ? mill_.walls.size() : balls());
    if (!on_wall && j <= i) reject("the ball with the lower number is not the first");
    const Real T = enclosure(line.at("time")), until = end(T, 1);
    if (!(end_ < end(T, -1))) reject("rule 1: it does not come after the one before");
    const Json &windows = line.at("windows"), &states = line.at("states");
    if (list(windows, 2).size() != 2u - on_wall || list(states, 2).size() != 2u - on_wall) reject("other bodies");
    happens(i, j, on_wall, T);
    no_wall(i, windows.at(0), until, on_wall ? static_cast<long>(j) : -1);
    no_ball(i, on_wall ? i : j, until, events_);
    if (!on_wall) no_wall(j, windows.at(1), until, -1), no_ball(j, i, until, events_);
    auto after = on_wall ? wall_impact(i, j, T) : pair_impact(i, j, T);
    for (Index k = 0; k < after.size(); ++k) {
      Flight& f = after[k];
      known(states.at(k), {"r", "v", "s"});
      f.r = holding(states.at(k).at("r"), f.r), f.v = holding(states.at(k).at("v"), f.v);
      f.s = holding(states.at(k).at("s"), f.s), f.m = middle(T), f.begin = end(T, -1), f.event = events_;
      (on_wall ? f.wall : f.with) = static_cast<long>(k == 0 ? j : i);
      flights_[k == 0 ? i : j] = at_zero(f), since_[k == 0 ? i : j] = T;
    }
    if (!on_wall && !dot(between(i, j, T), relative(i, j, T)).positive()) reject("rule 5: the balls do not part");
    end_ = until, ++events_;
  }
  void finish(const Json& line) {
    known(line, {"end", "windows"});
    if (line.at("windows").size() > balls()) reject("rule 6: the last line has windows of other balls");
    if (line.value("end", Json()) != events_) reject("rule 6: the last line names another number of events");
    for (Index i = 0; i < balls(); ++i) {
      if (flights_[i].event + 1 == events_ && events_ > 0) continue;
      if (!line.at("windows").contains(std::to_string(i))) reject("rule 6: the last line lacks a ball");
      no_wall(i, line.at("windows").at(std::to_string(i)), end_, -1), no_ball(i, i, end_, events_ - 1);
    }
  }

 private:
  [[noreturn]] void reject(const std::string& why) const { throw Rejected("event " + std::to_string(events_) + ": " + why); }
  /// The enclosures of the file, which must hold the computed ones. (rule 3)
  Vec holding(const Json& given, const Vec& computed) const {
    Vec result;
    for (Index k = 0; k < 3; ++k) {
      result[k] = enclosure(list(given, 3).at(k));
      if (!arb_contains(result[k].x, computed[k].x)) reject("rule 3: a state does not hold what the impact does");
    }
    return result;
  }
  Flight at_zero(Flight f) const {
    const AtPrecision scope(128);
    return f.r_0 = f.position(0, mill_.gravity), f.v_0 = f.velocity(0, mill_.gravity), f;
  }
  Vec position(Index i, const Real& t) const { return flights_[i].position(t, mill_.gravity); }
  Vec velocity(Index i, const Real& t) const { return flights_[i].velocity(t, mill_.gravity); }
  Vec relative(Index i, Index j, const Real& T) const { return velocity(i, middle(T)) - velocity(j, middle(T)); }
  /// r_i - r_j at a time, or on a bracket from its middle.
  Vec between(Index i, Index j, const Real& T) const {
    return position(i, middle(T)) - position(j, middle(T)) + relative(i, j, T) * (T - middle(T));
  }
  Real pair_gap(Index i, Index j, const Real& t) const {
    const Real reach = mill_.balls[i].radius + mill_.balls[j].radius;
    return dot(between(i, j, t), between(i, j, t)) - reach * reach;
  }
  Real wall_gap(Index i, Index wall, const Real& t) const {
    return mill_.gap(mill_.walls[wall], mill_.balls[i], mill_.pose(t).place(position(i, t)));
  }
  Real wall_rate(Index i, Index wall, const Real& T) const {
    const Pose pose = mill_.pose(T);
    return mill_.rate(mill_.walls[wall], pose.place(position(i, T)), pose.velocity(position(i, T), velocity(i, T)));
  }
  /// Rule 2.
  void happens(Index i, Index j, bool on_wall, const Real& T) const {
    const auto gap = [&](const Real& t) { return on_wall ? wall_gap(i, j, t) : pair_gap(i, j, t); };
    if (!gap(end(T, -1)).positive()) reject("rule 2: the bodies are not proven apart at the begin of the bracket");
    if (!gap(end(T, 1)).negative()) reject("rule 2: they are not proven to overlap at its end");
    const Real rate = on_wall ? wall_rate(i, j, T) : dot(between(i, j, T), relative(i, j, T));
    if (!rate.negative()) reject("rule 2: they are not proven to approach on it");
  }
  /// One letter of rule 4 from `from` to `to`, there or on parts: f from its middle with the range of f', or
  /// f' itself.
  bool holds(char letter, Index i, Index wall, const Real& from, const Real& to, int parts) const {
    const Real centre = (from + to) / 2, all = made(arb_union, from.x, to.x, precision), rate = wall_rate(i, wall, all);
    if (letter == 'p' && (wall_gap(i, wall, centre) + rate * (all - centre)).positive()) return true;
    if ((letter == 'r' && rate.positive()) || (letter == 'f' && rate.negative())) return true;
    return parts > 0 && holds(letter, i, wall, from, centre, parts - 1) && holds(letter, i, wall, centre, to, parts - 1);
  }
  /// Rule 4: letters and depths that fill the flight.
  void no_wall(Index i, const Json& texts, const Real& until, long end_wall) const {
    constexpr slong finest = 24, whole = 1L << finest;  // places in parts of 2^-24
    const Flight& f = flights_[i];
    if (list(texts, 64).size() != mill_.walls.size()) reject("rule 4: windows of other walls");
    for (Index wall = 0; wall < mill_.walls.size(); ++wall) {
      const std::string text = texts.at(wall);
      const long own = static_cast<long>(wall);
      slong at = 0;
      for (Index k = 0, next; k < text.size(); k = next) {
        next = std::min(text.find_first_of("prf", k + 1), text.size());
        const slong depth = small_number(text.substr(k + 1, next - k - 1));
        if (depth < 0 || depth > finest) reject("rule 4: a window of another depth");
        const slong to = at + (whole >> depth);
        if (at % (whole >> depth) != 0 || to > whole) reject("rule 4: windows that are no bisection");
        if (!(text[k] == 'p' || (text[k] == 'r' && at == 0 && f.wall == own) ||
              (text[k] == 'f' && to == whole && end_wall == own)))
          reject("rule 4: a letter in the wrong place");
        const auto place = [&](slong n) { return f.begin + (until - f.begin) * Real(n) / whole; };
        const auto proven = [&](slong bits) {
          const AtPrecision scope(bits);
          return holds(text[k], i, wall, place(at), place(to), 10);
        };
        if (!proven(128) && !proven(bits_)) reject("rule 4: a wall is not excluded");
        at = to;
      }
      if (at != whole) reject("rule 4: windows that leave a part of a flight out");
    }
  }
  /// Rule 5, for all flights that have not ended: those that ended earlier asked for this one then.
  void no_ball(Index i, Index partner, const Real& until, long through) const {
    for (Index j = 0; j < balls(); ++j) {
      const Flight &a = flights_[i], &b = flights_[j];
      if (j == i || j == partner || std::max(a.event, b.event) >= through) continue;
      if (a.event == b.event && a.with == static_cast<long>(j) && b.with == static_cast<long>(i)) continue;
      const Real &from = a.event > b.event ? a.begin : b.begin, reach = mill_.balls[i].radius + mill_.balls[j].radius;
      const auto quick = [&] {  // gravity, which both have, left out
        const AtPrecision scope(128);
        const Vec u = a.v_0 - b.v_0, x = a.r_0 - b.r_0;
        return apart(x + u * from, x + u * until, u, reach, until - from);
      };
      const auto exact = [&] {
        return apart(between(i, j, from), between(i, j, until), relative(i, j, from), reach, until - from);
      };
      if (!quick() && !exact()) reject("rule 5: balls are not proven apart");
    }
  }
  /// Whether f is proven positive, from r_i - r_j at either end of the time T, and v_i - v_j.
  static bool apart(const Vec& from, const Vec& to, const Vec& u, const Real& reach, const Real& T) {
    const Real f = dot(from, from) - reach * reach, slope = dot(from, u);
    if (f.positive() && (slope >= 0 || (f + 2 * slope * T).positive())) return true;
    return slope * slope < dot(u, u) * f || ((dot(to, to) - reach * reach).positive() && 0 >= dot(to, u));
  }
  /// "Stalls": whether friction rests in the ball's impact.
  bool rests(Index i, const Law& law, const Real& T) {
    const Real reached = (T - since_[i]) * 30000;
    const bool moved = law.least.zero() || reached >= law.least;
    if (!moved && !(reached < law.least)) reject("rule 3: whether a ball has moved is not decided");
    unmoved_[i] = moved ? 0 : unmoved_[i] + 1;
    return unmoved_[i] > 32;
  }
  /// P and Q of "Impulse".
  std::array<Vec, 2> impulse(const Law& law, const Vec& n, const Vec& G, const Real& c, bool smooth) const {
    const Real a = 0 - dot(G, n), e = law.restitution * a;
    if (!a.positive()) reject("rule 3: the surfaces do not approach each other");
    const bool by_restitution = e >= law.least;
    if (!by_restitution && !(e < law.least)) reject("rule 3: the speed of separation is not decided");
    const Real k = a + (by_restitution ? e : law.least);
    const Vec S = G + n * a;
    const Real L = root(dot(S, S)), reversed = 1 - law.tangential, friction = law.friction * c * k;
    smooth = smooth || (law.coulomb && law.friction.zero());
    const bool sticks = !law.coulomb || friction >= reversed * L;
    if (!sticks && !smooth && !(friction < reversed * L)) reject("rule 3: sliding is not decided");
    const Real gain = smooth ? Real() : sticks ? reversed / c : law.friction * k / L;
    return {n * k - S * gain, cross(n, S) * gain};
  }
  std::vector<Flight> wall_impact(Index i, Index j, const Real& T) {
    const Ball& ball = mill_.balls[i];
    const Wall& wall = mill_.walls[j];
    const Real m = middle(T), d = T - m;
    const Vec r = position(i, m), v = velocity(i, m), v_T = v + mill_.gravity * d, r_T = r + v_T * d;
    const Pose pose = mill_.pose(T);
    const Vec p = mill_.pose(m).place(r) + pose.velocity(r_T, v_T) * d, N = mill_.normal(wall, ball, p);
    const Vec n = pose.out(N), V_w = pose.V + cross(pose.w, pose.out(p - N * ball.radius)), s = flights_[i].s;
    const Vec G = (v_T - V_w) - cross(s * ball.radius, n);
    const Law& law = mill_.laws[mill_.law_of_walls[i][j]];
    const auto [P, Q] = impulse(law, n, G, 1 + 1 / ball.inertia, rests(i, law, T));
    return {{m, r - P * d, v + P, s + Q * (1 / (ball.radius * ball.inertia)), 0}};
  }
  std::vector<Flight> pair_impact(Index i, Index j, const Real& T) {
    const Ball &A = mill_.balls[i], &B = mill_.balls[j];
    const Real m = middle(T), d = T - m;
    const Vec n = between(i, j, T) / (A.radius + B.radius), &s_i = flights_[i].s, &s_j = flights_[j].s;
    const Real m_i = A.density * (A.radius * A.radius * A.radius), m_j = B.density * (B.radius * B.radius * B.radius);
    const Real share_i = m_j / (m_i + m_j), share_j = m_i / (m_i + m_j);
    const Vec G = relative(i, j, T) - cross(s_i * A.radius + s_j * B.radius, n);
    const Law& law = mill_.laws[mill_.law_of_balls[i][j]];
    const bool one = rests(i, law, T), other = rests(j, law, T);
    const auto [P, Q] = impulse(law, n, G, 1 + share_i / A.inertia + share_j / B.inertia, one || other);
    return {
        {m, position(i, m) - P * share_i * d, velocity(i, m) + P * share_i, s_i + Q * (share_i / (A.radius * A.inertia)), 0},
        {m, position(j, m) + P * share_j * d, velocity(j, m) - P * share_j, s_j + Q * (share_j / (B.radius * B.inertia)), 0}};
  }
  slong bits_;
  AtPrecision at_;
  Mill mill_;
  std::vector<Flight> flights_;
  std::vector<Real> since_;   ///< when flights began
  std::vector<int> unmoved_;  ///< impacts in a row that came without time to move
  Real end_;
  long events_ = 0;
};
/// @return "accepted: ..." @throws Rejected, or another std::exception for a file that is no certificate
inline std::string check(std::istream& in) {
  const auto next = [&] {
    std::string line;
    if (!std::getline(in, line) || line.find('\\') != line.npos) throw Rejected("rule 6: no line, or one with escapes");
    std::vector<Keys> keys;  // of the objects around
    return Json::parse(line, [&](int, Json::parse_event_t event, Json& key) {
      if (event == Json::parse_event_t::object_start) keys.emplace_back();
      if (event == Json::parse_event_t::object_end) keys.pop_back();
      if (event == Json::parse_event_t::key && !keys.back().insert(key).second)
        throw Rejected("rule 6: twice the key " + key.dump());
      return true;
    });
  };
  const Json header = known(next(), {"format", "version", "case", "digest", "events", "bits", "start", "gravity", "joints",
                                     "walls", "laws", "balls", "law_of_walls", "law_of_balls"});
  const Index bits = index(header.at("bits"), 65537), events = index(header.at("events"), Index(1) << 40);
  if (header.at("format") != "edmill certificate" || header.at("version") != 1 || bits < 64 || events < 1)
    throw std::invalid_argument("another format");
  Check check(header, static_cast<long>(bits));
  for (Index k = 0; k < events; ++k) check.take(next());
  check.finish(next());
  if (in.peek() != EOF) throw Rejected("rule 6: there is more behind the last line");
  const auto text = [](auto n) { return std::to_string(n); };
  return "accepted: " + text(events) + " events of " + text(check.balls()) + " balls in " + text(bits) + " bits";
}

}  // namespace checker
