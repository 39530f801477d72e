// First contact of a ball in free flight with the moving walls, as a certified decision.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>
#include <variant>
//
#include <boost/math/tools/toms748_solve.hpp>

#include "base/hermite.hpp"
#include "dynamics/body_groups.hpp"
#include "dynamics/flight.hpp"
#include "dynamics/gap_functions.hpp"
#include "model/mill.hpp"

namespace edmill::dynamics {

template <class Real> class AnyWallSearch;  // which a search in a wide scalar needs

/// In place of a search in a narrower scalar, which double has not.
struct NoSearch {
  explicit NoSearch(const auto&...) {}
};

/// Finds the first time in the window at which a gap is zero or negative and decreasing, for the
/// flight as stored. A ball that starts within rounding of a wall and leaves it is not in contact
/// until it returns; one that overlaps by rounding and approaches is in contact at once. Equations:
/// theory.md (2.17')-(2.22'); source: Barahona 2011, (2.17)-(2.22), corrected.
template <Motion M, Vessel V> class WallSearch {
 public:
  using Real = typename M::Scalar;
  using Query = WallQuery<Real>;
  using Answer = WallAnswer<Real>;
  using Functions = GapFunctions<M, V>;
  using Pose = typename M::Pose;
  using Sample = GapSample<V>;
  using Start = GapStart<V>;
  using Errors = GapErrors<V>;
  using Walls = WallSet<V>;

  WallSearch(const M& motion, const V& vessel, const Vec3<Real>& gravity);

  const Real& longest_window() const { return bounds_.longest_window(); }

  /// The answer to a query. In a wide scalar, double first decides what it can prove for its
  /// flight.
  /// @pre the ball is inside the vessel at `begin`, up to rounding
  Answer operator()(const Query& query) const {
    if constexpr (is_wide) {
      const auto answer = search_by_double(query);
      if (answer.verdict != Verdict::undecided) return answer;
    }
    return search(query);
  }

  /// For each wall, whether a ball at `position` in the vessel can reach it in a window of `length`
  /// [s] at up to `speed` [m/s]. False is a proof, by theory.md, section 3.
  Walls within_reach(const Functions& functions, const Vec3<Real>& position, const Real& speed,
      const Real& length) const;

  /// The search in this scalar alone.
  Answer search(const Query& query) const { return search(mill_.motion.pose(query.begin), query); }
  /// @param pose  of the vessel at the window's begin
  Answer search(const Pose& pose, const Query& query) const;

  /// The search in double, with only the root computed in this scalar; undecided if double cannot
  /// prove the result. The window searched may be a few roundings of double longer than requested.
  Answer search_by_double(const Query& query) const;

  /// The search in double for a wider scalar, whose flight, radius and mill were rounded to it.
  RoughAnswer rough(const Query& query) const;

  const MovingVessel<M, V>& mill() const { return mill_; }
 private:
  static constexpr bool is_wide = !std::is_same_v<Real, double>;
  static constexpr bool is_body = std::is_same_v<V, model::RoundedBody<Real>>;
  static constexpr bool is_widest = std::is_void_v<Wider<Real>>;
  using Point = numerics::Point<Real>;
  using Bounds = numerics::CurveBounds<Real>;

  /// One wall's gap along the flight.
  struct Curve {
    const Functions& functions;
    int wall;
    Bounds bounds;
    Point start;            ///< of the window
    const Real& curvature;  ///< there
    /// After which its search is undecided. In the widest scalar a rule would decide then; the
    /// bounds of bodies with round edges may need more steps.
    int most_steps = is_widest && is_body ? 100000 : 80;
    Point at(const Real& t) const { return of(functions(t)); }
    Point of(const Sample& s) const { return {s.offset, s.gap[wall], s.rate[wall]}; }
  };
  /// The root is in [left, right]; left == right if the contact is at this time.
  struct Bracket {
    Verdict verdict;
    Point left{}, right{};
    Real time_error{
        0};         ///< of a contact at once whose time does not follow from the gap's slope [s]
    Real guess{0};  ///< the only root, if the gap rises at first and is concave throughout; or zero
    bool at_once = false;  ///< the contact is certain, at the begin of the window
    bool by_rule = false;  ///< no precision decides; see isolate_by_rule
  };
  /// A root and the uncertainty of its time: the gap's rounding error over its slope.
  struct Root {
    Real t;
    Real time_error;
    [[no_unique_address]] ContactPose<Real> pose{};
    bool at_once = false;  ///< see Bracket
  };

  /// If `rounded`, bounds include the rounding of the flight and the mill, and `rough` is filled.
  template <bool rounded>
  Answer first_contact(const Functions& functions, const Start& first, Walls reachable,
      const Real& speed, const Query& query, RoughAnswer* rough) const;
  bool drop_clear(const auto& curve_of, Walls& reachable, Real& length,
      const DerivativeBounds<V>& derivatives) const;
  void require_length(const Query& query) const;
  Real clear_time(const Functions& functions, const Vec3<Real>& position, const Real& speed,
      const Real& length) const;
  /// The query with its window shortened so that all active gap functions are smooth in it.
  decltype(auto) smooth(const Query& query, const Functions& functions, const Vec3<Real>& position,
      const Real& speed) const;
  Real top_speed(const Vec3<Real>& velocity, const Real& length) const {
    return norm<Real>(velocity) + mill_.gravity_size * length;
  }
  [[gnu::noinline]] Bracket isolate_further(const Curve& curve, const Point& right,
      const Query& query, const Real& end, const Bracket& found) const;
  template <bool rounded> Bracket isolate_from_start(const Curve& curve, const Point& right) const;
  Bracket isolate(const Curve& curve, Point left, const Point& right) const;
  std::optional<Bracket> isolate_hop(const Curve& curve, const Point& right) const;
  Bracket isolate_outside(const Curve& curve, Point left, const Point& right, bool departing) const;
  Bracket isolate_touching(const Curve& curve, const Point& left, Point right) const;
  Bracket isolate_by_rule(const Curve& curve, const Point& right) const;
  Bracket isolate_rising(const Curve& curve, const Point& right) const;
  Bracket isolate_resting(const Curve& curve, const Point& right) const;
  Bracket follow_overlap(const Curve& curve, const Point& left, const Point& right) const;
  Sample sample_of_end(const Functions& functions, const Walls& reachable, const Errors& errors,
      const Real& from, Real& end) const;
  /// Data of a decreasing gap for Newton's iteration.
  struct Approach {
    Real guess;  ///< of the root
    double curvature, curvature_error, third;
  };
  template <bool rounded>
  std::optional<bool> comes_first(const Query& query, int wall, const Root& root, int other,
      const Root& other_root, bool& by_rule) const;
  std::optional<Root> polish(const Curve& curve, const Bracket& bracket) const;
  std::optional<Root> close_in(const Functions& functions, int wall, const Real& from,
      const Real& to, const Approach& approach, const Real& value_error) const;
  /// The end of a search for a root: a bracket of 7/8 of the resolution. toms748 begins with one
  /// resolution, so that a first step which removes an eighth of it is the last.
  auto closed() const {
    return [this](const Real& low, const Real& high) {
      const Real middle = low + (high - low) / 2;
      return high - low <= resolution() * 7 / 8 || middle <= low || middle >= high;
    };
  }
  /// Time resolution of a root [s], far above the rounding of a gap over its slope, for toms748.
  Real resolution() const { return 8 * epsilon<Real>() * mill_.clock.period(); }

  MovingVessel<M, V> mill_;
  BoundsTable<M, V> bounds_;
  Real own_speed_{0};  ///< no point of a body is faster [m/s]
  using RoughBodySearch = WallSearch<model::ChainMotion<double>, model::RoundedBody<double>>;
  using RoughSearch = std::conditional_t<is_body, RoughBodySearch, AnyWallSearch<double>>;
  [[no_unique_address]] std::conditional_t<is_wide, RoughSearch, NoSearch> rough_;
};

template <class Real>
using BodySearch = WallSearch<model::ChainMotion<Real>, model::RoundedBody<Real>>;

/// The wall search of a run, whose motion and vessel are known only when the case is read. In
/// double, cylinders on a SPEX and on a chain have searches with everything inlined. A general one,
/// with the same bits, selects the types of motion and vessel at every step.
template <class Real> class AnyWallSearch {
 public:
  using Query = WallQuery<Real>;
  using Answer = WallAnswer<Real>;
  using Spex = WallSearch<model::SpexMotion<Real>, model::CylinderVessel<Real>>;
  using OnChain = WallSearch<model::ChainMotion<Real>, model::CylinderVessel<Real>>;
  using General = WallSearch<model::AnyMotion<Real>, model::AnyVessel<Real>>;
  /// A search that replaces these; it receives the vessel's pose at the begin of the window.
  using Policy = std::function<Answer(const model::AnyPose<Real>&, const Query&)>;

  AnyWallSearch(const model::AnyMotion<Real>& motion, const model::AnyVessel<Real>& vessel,
      const Vec3<Real>& gravity)
      : search_(made(motion, vessel, gravity)) {
    longest_window_ = with([](const auto& search) { return search.longest_window(); });
    reach_ = with([](const auto& search) { return search.mill().reach; });
  }
  explicit AnyWallSearch(const model::Mill<Real>& mill)
      : AnyWallSearch(mill.motion, mill.vessel, mill.gravity) {
    walls_ = mill.vessel.wall_count();
    groups_ = BodyGroups(model::mill_cast<double>(mill).bodies);
    for (const auto& body : mill.bodies) {
      const auto& search = bodies_.emplace_back(body.motion, body.shape, mill.gravity);
      if (search.longest_window() < longest_window_) longest_window_ = search.longest_window();
    }
  }

  const Real& longest_window() const { return longest_window_; }
  /// Largest distance of a ball from the origin [m].
  const Real& reach() const { return reach_; }

  Answer operator()(const Query& query) const {
    auto answer = with([&]<class M, class V>(const WallSearch<M, V>& search) {
      if constexpr (std::is_same_v<WallSearch<M, V>, General>)
        if (policy_) return policy_(search.mill().motion.pose(query.begin), query);
      return search(query);
    });
    if (!bodies_.empty()) [[unlikely]]
      answer = with_bodies(query, answer);
    return answer;
  }
  Answer search(const model::AnyPose<Real>& pose, const Query& query) const {
    auto answer = with([&]<class M, class V>(const WallSearch<M, V>& search) {
      if constexpr (std::is_same_v<WallSearch<M, V>, General>)
        if (policy_) return policy_(pose, query);
      return search.search(model::pose_of<M>(pose), query);
    });
    if (!bodies_.empty()) [[unlikely]]
      answer = with_bodies(query, answer);
    return answer;
  }
  /// Replaces the search by a policy of the caller, whose answers are not certified.
  void replace(Policy policy) {
    search_ = with([](const auto& own) {
      const auto& mill = own.mill();
      return Search(std::in_place_type<General>, mill.motion, mill.vessel, mill.gravity);
    });
    policy_ = std::move(policy);
  }
  RoughAnswer rough(const Query& query) const {
    return with([&](const auto& search) { return search.rough(query); });
  }
 private:
  static constexpr bool is_double = std::is_same_v<Real, double>;
  using Search =
      std::conditional_t<is_double, std::variant<Spex, OnChain, General>, std::variant<General>>;

  static Search made(const model::AnyMotion<Real>& motion, const model::AnyVessel<Real>& vessel,
      const Vec3<Real>& gravity) {
    if constexpr (is_double) {
      const auto* cylinder = vessel.template get_if<model::CylinderVessel<Real>>();
      const auto* spex = motion.template get_if<model::SpexMotion<Real>>();
      const auto* chain = motion.template get_if<model::ChainMotion<Real>>();
      if (cylinder && !vessel.pistons()) {
        if (spex) return Search(std::in_place_type<Spex>, *spex, *cylinder, gravity);
        if (chain) return Search(std::in_place_type<OnChain>, *chain, *cylinder, gravity);
      }
    }
    return Search(std::in_place_type<General>, motion, vessel, gravity);
  }
  template <class F> [[gnu::always_inline]] decltype(auto) with(F&& f) const {
    if constexpr (is_double) {
      if (const auto* spex = std::get_if<Spex>(&search_)) [[likely]]
        return f(*spex);
      if (const auto* on_chain = std::get_if<OnChain>(&search_)) return f(*on_chain);
    }
    return f(*std::get_if<General>(&search_));
  }

  [[gnu::noinline]] Answer with_bodies(const Query& query, Answer first) const;
  Answer first_with_body(
      std::size_t body, const Query& query, const Real& length, const Real& clear) const;

  Search search_;
  std::vector<BodySearch<Real>> bodies_;
  BodyGroups groups_;
  int walls_ = 0;  ///< of the vessel
  Policy policy_;
  Real longest_window_, reach_;
};

// Instantiated in the sources that are compiled with all optimisations.
extern template class WallSearch<model::SpexMotion<double>, model::CylinderVessel<double>>;
extern template class WallSearch<model::ChainMotion<double>, model::CylinderVessel<double>>;
extern template class WallSearch<model::AnyMotion<double>, model::AnyVessel<double>>;
extern template class WallSearch<model::ChainMotion<double>, model::RoundedBody<double>>;
extern template class AnyWallSearch<double>;

}  // namespace edmill::dynamics
