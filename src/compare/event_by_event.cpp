#include "compare/event_by_event.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace edmill::compare {

namespace {

/// The next event within the limits.
std::optional<Event> next_within(LogReader& reader, const Limits& limits) {
  auto event = reader.next();
  while (event && limits.from && event->time < *limits.from) event = reader.next();
  if (event && limits.until && event->time > *limits.until) return std::nullopt;
  return event;
}

/// Least squares of a straight line, point by point.
class Line {
 public:
  void add(double x, double y) {
    ++n_;
    const double dx = x - mean_x_;
    mean_x_ += dx / n_;
    mean_y_ += (y - mean_y_) / n_;
    xx_ += dx * (x - mean_x_);
    xy_ += dx * (y - mean_y_);
  }
  double points() const { return n_; }
  double slope() const { return xy_ / xx_; }

 private:
  double n_ = 0, mean_x_ = 0, mean_y_ = 0, xx_ = 0, xy_ = 0;
};

}  // namespace

EventComparison compare_events(const std::filesystem::path& place_a, const std::filesystem::path& place_b,
                               const LogScan& scan_a, const LogScan& scan_b, const Limits& limits,
                               double tolerance) {
  LogReader log_a(place_a), log_b(place_b);
  EventComparison result;
  Line growth;
  for (;;) {
    const auto a = next_within(log_a, limits), b = next_within(log_b, limits);
    if (!a || !b) break;  // events beyond the end of either log are not compared
    if (!a->same_bodies(*b)) {
      if (!result.first) result.first = {*a, *b, "partners", std::numeric_limits<double>::quiet_NaN()};
      break;
    }
    ++result.same_partners;
    if (result.first) continue;
    OfEach<double> difference{};
    for (std::size_t v = 0; v < model::logged_count; ++v) {
      if (!scan_a.has[v] || !scan_b.has[v]) continue;
      const double scale = std::max(std::abs((*a)[v]), scan_a.mean_magnitude[v]);
      const double distance = std::abs((*a)[v] - (*b)[v]);
      if (distance > 0)
        difference[v] = scale > 0 ? distance / scale : std::numeric_limits<double>::infinity();
    }
    const auto worst = std::max_element(difference.begin(), difference.end());
    if (*worst > tolerance) {
      const auto v = static_cast<std::size_t>(worst - difference.begin());
      result.first = {*a, *b, std::string(model::logged_quantities[v].name), *worst};
      continue;
    }
    for (std::size_t v = 0; v < model::logged_count; ++v)
      result.largest[v] = std::max(result.largest[v], difference[v]);
    if (*worst > 0) growth.add(static_cast<double>(result.agreeing), std::log10(*worst));
    ++result.agreeing;
    result.horizon = a->time;
  }
  if (growth.points() >= 10) result.digits_lost_per_event = growth.slope();
  return result;
}

}  // namespace edmill::compare
