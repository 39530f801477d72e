// The wall search of a run, whose motion and vessel are chosen when the case is read.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "dynamics/wall_search.hpp"
#include "model/mill.hpp"

namespace edmill::dynamics {

/// In double the SPEX with a cylinder has a search of its own, in which everything is inlined; all else goes
/// through one that asks the motion and the vessel what they are at every step. Both give the same bits.
template <class Real>
class AnyWallSearch {
 public:
  using Spex = WallSearch<model::SpexMotion<Real>, model::CylinderVessel<Real>>;
  using General = WallSearch<model::AnyMotion<Real>, model::AnyVessel<Real>>;
  /// Another search in the place of these, given the vessel's pose at the window's begin.
  using Policy = std::function<WallAnswer<Real>(const model::AnyPose<Real>&, const WallQuery<Real>&)>;

  AnyWallSearch(const model::AnyMotion<Real>& motion, const model::AnyVessel<Real>& vessel,
                const Vec3<Real>& gravity) {
    model::with_parts<Real>(motion, vessel, [&](const auto& its_motion, const auto& its_vessel) {
      using Search = WallSearch<std::decay_t<decltype(its_motion)>, std::decay_t<decltype(its_vessel)>>;
      if constexpr (std::is_same_v<Search, General>)
        general_.emplace(its_motion, its_vessel, gravity);
      else
        spex_.emplace(its_motion, its_vessel, gravity);
    });
    longest_window_ = with([](const auto& search) { return search.longest_window(); });
    reach_ = with([](const auto& search) { return search.mill().reach; });
  }
  explicit AnyWallSearch(const model::Mill<Real>& mill)
      : AnyWallSearch(mill.motion, mill.vessel, mill.gravity) {}

  const Real& longest_window() const { return longest_window_; }
  /// Largest distance of a ball from the origin [m].
  const Real& reach() const { return reach_; }

  WallAnswer<Real> operator()(const WallQuery<Real>& query) const {
    return with([&]<class M, class V>(const WallSearch<M, V>& search) {
      if constexpr (std::is_same_v<WallSearch<M, V>, General>)
        if (policy_) return policy_(search.mill().motion.pose(query.begin), query);
      return search(query);
    });
  }
  WallAnswer<Real> search(const model::AnyPose<Real>& pose, const WallQuery<Real>& query) const {
    return with([&]<class M, class V>(const WallSearch<M, V>& search) {
      if constexpr (std::is_same_v<WallSearch<M, V>, General>)
        if (policy_) return policy_(pose, query);
      return search.search(model::pose_of<M>(pose), query);
    });
  }
  /// From here on a policy of the caller's own decides, which nothing certifies.
  void replace(Policy policy) {
    if constexpr (std::is_same_v<Real, double>)
      if (spex_) general_.emplace(spex_->mill().motion, spex_->mill().vessel, spex_->mill().gravity);
    spex_.reset();
    policy_ = std::move(policy);
  }
  RoughAnswer rough(const WallQuery<Real>& query) const {
    return with([&](const auto& search) { return search.rough(query); });
  }

 private:
  template <class F>
  [[gnu::always_inline]] decltype(auto) with(F&& f) const {
    if constexpr (std::is_same_v<Real, double>)
      if (spex_) [[likely]]
        return f(*spex_);
    return f(*general_);
  }

  struct Never {
    void emplace(const auto&...) {}
    void reset() {}
  };
  std::conditional_t<std::is_same_v<Real, double>, std::optional<Spex>, Never> spex_{};
  std::optional<General> general_;
  Policy policy_;
  Real longest_window_, reach_;
};

}  // namespace edmill::dynamics
