// The event-driven simulation: next event, propagate, collide, notify observers, predict.
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/memory.hpp"
#include "dynamics/decision_ladder.hpp"
#include "engine/agenda.hpp"
#include "engine/candidates.hpp"
#include "engine/event_queue.hpp"
#include "engine/observer.hpp"
#include "engine/prefetcher.hpp"
#include "engine/watches.hpp"
#include "model/case.hpp"
#include "model/outcome.hpp"

namespace edmill::engine {

using model::EndReason;

template <class Real> struct EngineCounts {
  std::uint64_t impacts = 0;
  std::uint64_t stale_events = 0;
  std::uint64_t cell_crossings = 0;
  std::uint64_t wall_searches = 0;
  std::uint64_t simultaneous_contacts = 0;  ///< of one ball at times that no scalar could separate
  Real deepest_overlap{0};                  ///< by rounding, at any impact [m]

  void archive(Archive& a) {
    a(impacts, stale_events, cell_crossings, wall_searches, simultaneous_contacts, deepest_overlap);
  }
};

template <class Real> using States = std::vector<model::BallState<Real>>;

/// A run of one case. Balls are advanced only when they collide; every contact is certified.
template <class Real> class Simulation {
  using Instant = edmill::Instant<Real>;
  using Event = engine::Event<Real>;
  using Agenda = engine::Agenda<Real>;
  using Impact = engine::Impact<Real>;
  using Pose = model::AnyPose<Real>;
  using DoubleState = typename Candidates<Real>::DoubleState;
  static constexpr bool is_double = std::is_same_v<Real, double>;
 public:
  /// @param states  of the case's balls, in order, at `start`
  /// @pre no two balls overlap and all are inside the vessel, up to rounding
  /// @throws InterruptedError when `interrupt` becomes true meanwhile
  Simulation(const model::Case<Real>& the_case, const States<Real>& states, const Instant& start,
      const std::atomic<bool>* interrupt = nullptr);
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;

  /// Observers get every impact, in the order of attachment; they must outlive the run.
  void attach(Observer<Real>& observer) { observers_.push_back(&observer); }

  /// Processes every event up to `end`, inclusive; returns early when an observer asks for it, on
  /// collapse and stalls, or when `interrupt` becomes true. Can be called again with a later end.
  EndReason run_until(const Instant& end, const std::atomic<bool>* interrupt = nullptr);

  /// Enables or disables prefetching, which changes no result (default: enabled with many balls).
  void prefetch(bool yes) { prefetcher_.enable(yes && candidates_.uses_cells()); }

  /// Replaces the wall search by another one, which is not certified: for comparisons.
  void replace_wall_search(typename dynamics::AnyWallSearch<Real>::Policy policy) {
    ladder_.walls().replace(std::move(policy));
  }

  /// Asks the loop to return after the present impact.
  void request_stop(EndReason reason) { stop_ = reason; }
  /// Asks the loop to return for a pause; any other reason takes precedence.
  void request_pause() {
    if (!stop_) stop_ = EndReason::paused;
  }

  /// Saves or loads everything that changes, so that another simulation of the case has the same
  /// bits.
  /// @pre no event is being processed
  /// @throws InputError when the loaded data cannot be a state of this case
  void archive(Archive& a);

  const Instant& now() const { return now_; }
  Real seconds() const { return clock_.seconds(now_); }
  const DriveClock<Real>& clock() const { return clock_; }
  /// The instant of a record at `time` [s]: the current one where they agree up to rounding.
  Instant instant_of(const Real& time) const {
    const Real off = time - seconds(), unit = 8 * epsilon<Real>() * (time + clock_.period());
    return off <= unit && off >= -unit ? now_ : clock_.at(time);
  }
  int ball_count() const { return static_cast<int>(flights_.size()); }
  const model::Mill<Real>& mill() const { return mill_; }
  const model::BallProperties<Real>& properties(int i) const { return balls_[i * stride_]; }
  const dynamics::Flight<Real>& flight(int i) const { return flights_[i]; }
  const Vec3<Real>& spin(int i) const { return bodies_[i].spin; }
  model::BallState<Real> state_at(int i, const Instant& when) const;
  model::Energy<Real> energy_at(const Instant& when) const;
  const EngineCounts<Real>& counts() const { return counts_; }
  std::vector<model::Escalations> escalations() const { return ladder_.escalations(); }
  const std::optional<model::InelasticCollapse<Real>>& collapse() const { return collapse_; }
  const std::optional<model::Stall<Real>>& stall() const { return stall_; }
 private:
  bool is_sound() const;
  Event event_of(int ball);
  Event queued_event(int ball) const;
  void requeue(int ball);
  void drop_void_contact(int ball);
  void cross_cell(int ball);
  void continue_wall_search(int ball, const Instant& begin);

  bool has_rivals(const Event& event) const;
  Event settle_ties(Event event);
  void find_rivals(const Event& event, const Instant& limit);
  void add_near(int ball, std::vector<int>& balls);
  void add_rivals_of_full_agenda(int ball, const Event& event, const Instant& limit);
  dynamics::Contact<Real> contact_of(const Event& event) const;

  Impact collide(const Event& event);
  Impact collide_with_wall(const Event& event);
  Impact collide_pair(const Event& event);
  void update_pose();
  void raise_top_speed(int ball);
  bool friction_rests(int ball, const Real& flight_time, const model::ContactLaw<Real>& law);
  void notify(const Impact& impact);
  void note_collapse(const Impact& impact, int ball, int partner);

  void predict(const Impact& impact);
  void predict_all(int ball, int already_done, const Pose& pose, FoundBalls& near);
  /// The balls of the adjacent cells, where cells are used.
  void find_neighbours(int ball, FoundBalls& near) {
    if (!candidates_.uses_cells()) return;
    candidates_.grid().neighbours(bodies_[ball].cell, near);
    prefetcher_.flights_of(near);
  }
  void predict_pairs(
      int ball, int already_done, const DoubleState& state, int found, const FoundBalls& near);
  void expect_pair(int ball, int other, const Real& delay);
  void predict_crossing(int ball, const DoubleState& state);
  void predict_wall(int ball, const Pose& pose);
  Real search_length(int ball, const Instant& begin) const;
  void take_wall_answer(int ball, const dynamics::WallAnswer<Real>& answer, const Instant& begin);

  model::Mill<Real> mill_;
  DriveClock<Real> clock_;
  Balls<Real> balls_;
  int stride_;  ///< 0 if all balls are identical: then the first entry, in the cache, is used
  LargeVector<dynamics::Flight<Real>> flights_;
  LargeVector<Body<Real>> bodies_;
  Agendas<Real> agendas_;
  Real top_speed_;  ///< of any ball at any time, at most [m/s]; it grows
  dynamics::DecisionLadder<Real> ladder_;
  Candidates<Real> candidates_;
  EventQueue<Real> queue_;
  Prefetcher<Real> prefetcher_;
  CollapseWatch<Real> collapse_watch_;
  bool may_collapse_;  ///< a law lets bodies separate at any speed
  Real slow_;  ///< largest approach speed that acceleration gives over the smallest path [m/s]
  StallWatch<Real> stall_watch_;
  std::vector<Observer<Real>*> observers_;
  EngineCounts<Real> counts_;
  std::optional<model::InelasticCollapse<Real>> collapse_;
  std::optional<model::Stall<Real>> stall_;
  std::optional<EndReason> stop_;
  Instant now_;
  Real tolerated_overlap_;  ///< above rounding and errors of states, far below a missed impact [m]
  Real fall_;               ///< the most that gravity adds to a ball's speed in one flight [m/s]
  // Scratch, valid during one event.
  FoundBalls near_, near_partner_;  ///< balls of the adjacent cells
  Pose pose_;                       ///< now
  std::vector<Event> rivals_;       ///< contacts that may be first
};

// Instantiated in the source that is compiled with all optimisations.
extern template class Simulation<double>;

}  // namespace edmill::engine
