#include <algorithm>
#include <cmath>
#include <numeric>

#include "identify/candidates.hpp"

namespace edmill::identify {

auto Samples::every() const -> Places {
  Places all(violating_.size());
  std::iota(all.begin(), all.end(), std::size_t{0});
  return all;
}

void Samples::choose() {
  const auto& events = *events_;
  const auto known =
      std::find_if(events.begin(), events.end(), [](const auto& e) { return std::isfinite(e.time); });
  const double begin = known == events.end() ? 0 : known->time, end = events.back().time, span = end - begin;
  const double first = std::max(period_, events[std::min<std::size_t>(79, events.size() - 1)].time - begin);
  windows_.clear();
  for (double window = first; window < span; window *= 4) windows_.push_back(sample(begin + window, 160));
  windows_.push_back(sample(end, 300));
  few_ = sample(end, 80);
  many_ = sample(end, 1500);
}

auto Samples::sample(double until, std::size_t most) const -> Places {
  Places all, violating, chosen;
  for (std::size_t k = 0; k < events_->size() && (*events_)[k].time <= until; ++k) {
    all.push_back(k);
    if (violating_[k]) violating.push_back(k);
  }
  if (all.size() <= most) return all;
  for (const auto* list : {&violating, &all}) {
    const std::size_t number = std::min(list->size(), list == &all ? most - chosen.size() : most / 2);
    for (std::size_t k = 0; k < number; ++k) chosen.push_back((*list)[k * list->size() / number]);
  }
  std::sort(chosen.begin(), chosen.end());
  chosen.erase(std::unique(chosen.begin(), chosen.end()), chosen.end());
  return chosen;
}

}  // namespace edmill::identify
