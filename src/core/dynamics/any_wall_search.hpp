// The wall search of a run, whose motion and vessel are chosen when the case is read.
#pragma once

#include <functional>
#include <optional>
#include <type_traits>
#include <utility>

#include "dynamics/wall_search.hpp"
#include "model/mill.hpp"

namespace edmill::dynamics {

/// In double a cylinder has searches of its own, for the SPEX and for a chain, in which everything is
/// inlined; all else goes through one that asks the motion and the vessel what they are at every step. They
/// give the same bits.
template <class Real>
class AnyWallSearch {
 public:
  using Spex = WallSearch<model::SpexMotion<Real>, model::CylinderVessel<Real>>;
  using OnChain = WallSearch<model::ChainMotion<Real>, model::CylinderVessel<Real>>;
  using General = WallSearch<model::AnyMotion<Real>, model::AnyVessel<Real>>;
  /// Another search in the place of these, given the vessel's pose at the window's begin.
  using Policy = std::function<WallAnswer<Real>(const model::AnyPose<Real>&, const WallQuery<Real>&)>;

  AnyWallSearch(const model::AnyMotion<Real>& motion, const model::AnyVessel<Real>& vessel,
                const Vec3<Real>& gravity) {
    if constexpr (std::is_same_v<Real, double>) {
      const auto* cylinder = vessel.template get_if<model::CylinderVessel<Real>>();
      const auto* spex = motion.template get_if<model::SpexMotion<Real>>();
      const auto* chain = motion.template get_if<model::ChainMotion<Real>>();
      if (cylinder && !vessel.pistons()) {
        if (spex) spex_.emplace(*spex, *cylinder, gravity);
        if (chain) on_chain_.emplace(*chain, *cylinder, gravity);
      }
      if (!spex_ && !on_chain_) general_.emplace(motion, vessel, gravity);
    } else {
      general_.emplace(motion, vessel, gravity);
    }
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
    const auto keep = [&](const auto& own) {
      if constexpr (std::is_same_v<Real, double>)
        if (own) general_.emplace(own->mill().motion, own->mill().vessel, own->mill().gravity);
    };
    keep(spex_), keep(on_chain_);
    spex_.reset(), on_chain_.reset();
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
    if constexpr (std::is_same_v<Real, double>)
      if (on_chain_) return f(*on_chain_);
    return f(*general_);
  }

  struct Never {
    void emplace(const auto&...) {}
    void reset() {}
  };
  std::conditional_t<std::is_same_v<Real, double>, std::optional<Spex>, Never> spex_{};
  std::conditional_t<std::is_same_v<Real, double>, std::optional<OnChain>, Never> on_chain_{};
  std::optional<General> general_;
  Policy policy_;
  Real longest_window_, reach_;
};

// Their inline functions come from where they are optimised.
extern template class WallSearch<model::SpexMotion<double>, model::CylinderVessel<double>>;
extern template class WallSearch<model::ChainMotion<double>, model::CylinderVessel<double>>;
extern template class WallSearch<model::AnyMotion<double>, model::AnyVessel<double>>;

}  // namespace edmill::dynamics
