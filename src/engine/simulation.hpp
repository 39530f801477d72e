// The event-driven simulation: next event, propagate, collide, tell, predict.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstdint>
#include <optional>
#include <tuple>
#include <type_traits>
#include <vector>

#include "base/memory.hpp"
#include "dynamics/decision_ladder.hpp"
#include "engine/cell_grid.hpp"
#include "engine/collapse_watch.hpp"
#include "engine/event_queue.hpp"
#include "engine/flight_table.hpp"
#include "engine/observer.hpp"
#include "model/case.hpp"
#include "model/outcome.hpp"

namespace edmill::engine {

/// Why a run ended.
enum class EndReason {
  end_time,
  max_collisions,
  max_milling_dose,
  max_ball_speed,
  inelastic_collapse,
  interrupted,
  paused,  ///< an observer wants to look at it between two events
};

/// What the engine counts about itself.
template <class Real>
struct EngineCounts {
  std::uint64_t impacts = 0;
  std::uint64_t stale_events = 0;
  std::uint64_t cell_crossings = 0;
  std::uint64_t wall_searches = 0;
  std::uint64_t simultaneous_contacts = 0;  ///< of one ball at times that no scalar could tell apart
  Real deepest_overlap{0};                  ///< by rounding, at any impact [m]

  void archive(Archive& a) {
    a(impacts, stale_events, cell_crossings, wall_searches, simultaneous_contacts, deepest_overlap);
  }
};

/// A run of one case. Balls are advanced only when they collide; every predicted contact is certified.
template <class Real>
class Simulation {
 public:
  /// @param states  of the case's balls, in order, at `start`
  /// @pre no two balls overlap and all are inside the vessel, up to rounding
  /// @throws InterruptedError when `interrupt` becomes true meanwhile
  Simulation(const model::Case<Real>& the_case, const std::vector<model::BallState<Real>>& states,
             const Instant<Real>& start, const std::atomic<bool>* interrupt = nullptr);

  /// Observers are told of every impact, in the order of attachment; they must outlive the run.
  void attach(Observer<Real>& observer) { observers_.push_back(&observer); }

  /// Processes every event up to `end`, inclusive; returns early when an observer asks for it, on collapse,
  /// or when `interrupt` becomes true. Can be called again with a later end.
  EndReason run_until(const Instant<Real>& end, const std::atomic<bool>* interrupt = nullptr);

  /// Asks the loop to return after the present impact.
  void request_stop(EndReason reason) { stop_ = reason; }
  /// The same, for nothing more than a pause: any other reason goes before.
  void request_pause() {
    if (!stop_) stop_ = EndReason::paused;
  }

  /// Everything that changes in a run, so that another simulation of the same case goes on with the same
  /// bits.
  /// @pre no event is being processed
  void archive(Archive& a);

  const Instant<Real>& now() const { return now_; }
  Real seconds() const { return clock_.seconds(now_); }
  const DriveClock<Real>& clock() const { return clock_; }
  /// The instant of a record at `time` [s]; what is now but for the rounding of seconds is now.
  Instant<Real> instant_of(const Real& time) const {
    const Real off = time - seconds(), unit = 8 * epsilon<Real>() * (time + clock_.period());
    return off <= unit && off >= -unit ? now_ : clock_.at(time);
  }
  int ball_count() const { return static_cast<int>(flights_.size()); }
  const model::Mill<Real>& mill() const { return mill_; }
  const model::BallProperties<Real>& properties(int i) const { return balls_[i * stride_]; }
  const dynamics::Flight<Real>& flight(int i) const { return flights_[i]; }
  const Vec3<Real>& spin(int i) const { return bodies_[i].spin; }
  model::BallState<Real> state_at(int i, const Instant<Real>& when) const;
  model::Energy<Real> energy_at(const Instant<Real>& when) const;
  const EngineCounts<Real>& counts() const { return counts_; }
  std::vector<Escalations> escalations() const { return ladder_.escalations(); }
  const std::optional<model::InelasticCollapse<Real>>& collapse() const { return collapse_; }

 private:
  enum class EventKind { wall_contact, pair_contact, cell_crossing, wall_recheck };
  /// What a ball expects. Its pair contacts are those that it predicted itself, in any order; one is void
  /// once the partner has had an impact since, and for a pair that both predicted the later prediction is the
  /// valid one. Which entry is the earliest is a coin toss, so it is found without branches.
  struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Agenda {
    static constexpr int capacity = 3;
    static constexpr int wall_entry = 0, crossing_entry = 1, first_pair = 2;
    std::array<Instant<Real>, first_pair + capacity> times;  ///< of wall, crossing, pairs; never() where free
    [[no_unique_address]] dynamics::ContactPose<Real> wall_pose;  ///< at the wall's time
    Instant<Real> forgotten_from;  ///< contacts from this time on found no room; never() when all are kept
    std::array<int, capacity> partners{};
    std::array<std::uint32_t, capacity> known;  ///< number of the latest impact of all, when predicted
    std::uint32_t last_impact = 0;              ///< number of the ball's latest
    std::int8_t pair_count = 0;
    /// A wall id, or -1 when the wall's time only ends what has been searched; `tied` more when another wall
    /// is hit at the same time.
    std::int8_t wall = -1;
    std::int8_t crossing_face = 0;  ///< twice the axis, and 1 more when upwards
    std::int8_t next = wall_entry;  ///< the entry that was queued

    Agenda() {
      times.fill(Instant<Real>::never());
      drop_pairs();
    }

    static int select(bool condition, int yes, int no) {
      return no ^ ((yes ^ no) & -static_cast<int>(condition));
    }

    /// Entries of the earliest and the latest pair contact, when there are any.
    int nearest() const {
      const int first = first_pair + (times[first_pair + 1] < times[first_pair]);
      return select(times[first_pair + 2] < times[first], first_pair + 2, first);
    }
    int farthest() const {
      const int last = first_pair + (times[first_pair + 1] > times[first_pair]);
      return select(times[first_pair + 2] > times[last], first_pair + 2, last);
    }
    static constexpr int tied = 64;
    bool hits_wall() const { return wall >= 0; }
    bool wall_is_tied() const { return wall >= tied; }
    int wall_id() const { return wall % tied; }
    int crossing_axis() const { return crossing_face / 2; }
    int crossing_step() const { return crossing_face % 2 ? 1 : -1; }
    int partner_at(int entry) const { return partners[entry - first_pair]; }
    void put_pair(int entry, const Instant<Real>& time, int partner, std::uint32_t latest_impact) {
      times[entry] = time;
      partners[entry - first_pair] = partner;
      known[entry - first_pair] = latest_impact;
    }
    void drop_nearest() {
      const int first = nearest(), last = first_pair + --pair_count;
      put_pair(first, times[last], partners[last - first_pair], known[last - first_pair]);
      times[last] = Instant<Real>::never();
    }
    void drop_pairs() {
      for (int k = 0; k < capacity; ++k) times[first_pair + k] = Instant<Real>::never();
      pair_count = 0;
      forgotten_from = Instant<Real>::never();
    }

    void archive(Archive& a) {
      a(times, wall_pose, forgotten_from, partners, known, last_impact, pair_count, wall, crossing_face);
    }
  };
  /// What events need of a ball besides its flight. In double it is one cache line.
  struct alignas(sizeof(Real) == 8 ? 64 : alignof(Real)) Body {
    Vec3<Real> spin;
    RecentImpacts<Real> recent;
    CellOfBall cell;

    void archive(Archive& a) { a(spin, recent, cell); }
  };
  static_assert(sizeof(Real) != 8 || sizeof(Body) == 64);
  bool still_holds(const Agenda& a, int pair_entry) const {
    return agendas_[a.partner_at(pair_entry)].last_impact <= a.known[pair_entry - Agenda::first_pair];
  }
  struct Event {
    EventKind kind;
    Instant<Real> time;
    int ball;
    int partner;
    bool by_rule = false;  ///< a rule put it before another contact

    bool involves(int other) const {
      return ball == other || (kind == EventKind::pair_contact && partner == other);
    }
    bool shares_ball(const Event& other) const {
      return involves(other.ball) || (other.kind == EventKind::pair_contact && involves(other.partner));
    }
    bool same_bodies(const Event& other) const {
      if (kind != other.kind) return false;
      return (ball == other.ball && partner == other.partner) ||
             (kind == EventKind::pair_contact && ball == other.partner && partner == other.ball);
    }
    /// The rule for contacts at one time: a wall goes before a ball, then the lower numbers.
    bool goes_before(const Event& other) const {
      const auto place = [](const Event& e) {
        const bool pair = e.kind == EventKind::pair_contact;
        return std::tuple(pair, pair ? std::min(e.ball, e.partner) : e.ball,
                          pair ? std::max(e.ball, e.partner) : e.partner);
      };
      return place(*this) < place(other);
    }
  };

  Event next_of(int ball) const;
  void requeue(int ball);

  void process(const Event& event);
  void drop_stale(int ball);
  void cross_cell(int ball);
  void collide_with_wall(const Event& event);
  model::VesselPose<Real> pose_now() const;
  model::VesselPose<Real> pose_at_wall_contact(int ball) const;
  void collide_pair(const Event& event);
  [[gnu::noinline]] void number_anew();
  void number_impact(int ball, int partner);
  void after_impact(Impact<Real>& impact);
  void note_collapse(const Impact<Real>& impact, int ball, int key, bool with_wall, int partner);
  bool has_rivals(const Event& event) const;
  Event settle_ties(Event event);
  void finish_wall_searches(const Event& event, const Instant<Real>& limit);
  void find_rivals(const Event& event, const Instant<Real>& limit);
  void add_rivals_of_full_agenda(int ball, const Event& event, const Instant<Real>& limit);
  dynamics::Contact<Real> contact_of(const Event& event) const;

  using RoughlySeen = dynamics::PairSearch<double>::Seen;
  RoughlySeen see_roughly(int ball) const {
    return pair_filter_.seen(rough_flights()[ball], dynamics::instant_cast<double>(now_));
  }
  /// In the scalar itself, where a look in double has found something.
  decltype(auto) see(int ball, const RoughlySeen& roughly) const {
    if constexpr (std::is_same_v<Real, double>)
      return (roughly);
    else
      return ladder_.pairs().seen(flights_[ball], now_);
  }
  bool many_balls() const { return flights_.size() > 1024; }  ///< more than the near caches hold
  void fetch_flights(const FoundBalls& near) const;
  void fetch_neighbours(int ball, FoundBalls& near) const;
  void fetch_ball(int ball) const;
  void look_ahead();
  void fetch_portion();
  void fetch_more() {
    if (fetched_ < portions) fetch_portion();
  }
  void flight_changed(int ball);
  int look_around(int ball, const RoughlySeen& roughly, FoundBalls& near);
  int look_at_near(int ball, const RoughlySeen& roughly, FoundBalls& near);
  const dynamics::Flight<double>* rough_flights() const {
    if constexpr (std::is_same_v<Real, double>)
      return flights_.data();
    else
      return rough_flights_.data();
  }
  /// What the pair filter is asked about a ball.
  PairQuestion question(int ball, const RoughlySeen& roughly) const {
    return {roughly, radii_[ball * stride_], dynamics::instant_cast<double>(now_), pair_filter_.filter()};
  }
  void predict_suspects(int ball, int already_done, const RoughlySeen& roughly, int found,
                        const FoundBalls& near);
  void expect_pair(int ball, int other, const Real& delay);
  void predict_crossing(int ball, const RoughlySeen& roughly);
  void predict_wall(int ball, const model::VesselPose<Real>& pose);
  void continue_wall_search(int ball, const Instant<Real>& begin);
  Real search_length(int ball, const Instant<Real>& begin) const;
  void take_wall_answer(int ball, const dynamics::WallAnswer<Real>& answer, const Instant<Real>& begin);
  void predict_all(int ball, int already_done, const model::VesselPose<Real>& pose, FoundBalls& near);

  model::Mill<Real> mill_;
  DriveClock<Real> clock_;
  std::vector<model::BallProperties<Real>> balls_;
  LargeVector<dynamics::Flight<Real>> flights_;
  LargeVector<Body> bodies_;
  LargeVector<Agenda> agendas_;
  std::uint32_t impact_number_ = 0;  ///< of the latest one, since they were last numbered anew
  dynamics::DecisionLadder<Real> ladder_;
  // Pairs are filtered in double whatever the scalar: its bounds cover the rounding of the flights to double.
  // Cells are crossed in double too: their margin covers it.
  dynamics::PairSearch<double> pair_filter_;
  LargeVector<dynamics::Flight<double>> rough_flights_;  ///< empty when the scalar is double
  std::vector<double> radii_;                            ///< rounded too
  int stride_;  ///< 0 when all balls are alike: then the first entry, always at hand, serves for every ball
  CellGrid grid_;
  std::optional<FlightTable> table_;  ///< instead of the grid when that has one cell
  EventQueue<Real> queue_;
  CollapseWatch<Real> collapse_watch_;
  static constexpr int portions = 4;
  std::array<int, 3> upcoming_{};   ///< balls of the next events, most likely
  int fetched_ = portions;          ///< of what they need
  FoundBalls near_, near_partner_;  ///< scratch: balls of the adjacent cells
  Looks looks_;                     ///< scratch: what the pair filter saw
  std::vector<int> due_;            ///< scratch: balls with an event at nearly the same time
  std::vector<Event> rivals_;       ///< scratch: contacts that may be first
  std::vector<Observer<Real>*> observers_;
  EngineCounts<Real> counts_;
  std::optional<model::InelasticCollapse<Real>> collapse_;
  std::optional<EndReason> stop_;
  Instant<Real> now_;
  Real tolerated_overlap_;  ///< far above rounding and given states, far below a missed impact [m]
  Real fall_;               ///< that a flight adds to a ball's speed at most [m/s]
  Real top_speed_;          ///< of any ball at any time; it grows
};

}  // namespace edmill::engine
