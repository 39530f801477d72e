#include <algorithm>
#include <cmath>
#include <sstream>

#include "app/judge.hpp"
#include "dem/contact_rates.hpp"
#include "plot/chart.hpp"

namespace edmill::app {

std::string limit_drawing(const dem::Limit& limit) {
  const double last = 1e6 * limit.points.front().contact_time, value = limit.at_zero.dose_rate;
  plot::Chart chart{"limit",
                    "dose rate over contact time",
                    "dose rates of runs with contacts of several durations, and their limit",
                    {"contact time [us]", 0, 1.08 * last},
                    {"dose rate [W]", INFINITY, -INFINITY}};
  chart.curves.push_back({"line", "c0", {{0, value}, {last, value + 1e-6 * limit.slope * last}}});
  const auto bar = [&](double x, const dem::ContactRates& r, const char* colour, const char* name) {
    const double low = r.dose_rate - r.half_width, high = r.dose_rate + r.half_width;
    chart.y.low = std::min(chart.y.low, low);
    chart.y.high = std::max(chart.y.high, high);
    chart.curves.push_back({name, colour, {{x, low}, {x, high}}});
  };
  for (const auto& p : limit.points)
    bar(1e6 * p.contact_time, p, "c1", &p == &limit.points.front() ? "runs" : "");
  bar(0.004 * last, limit.at_zero, "c0", "limit");
  if (limit.to_edmill) bar(0.012 * last, limit.to_edmill->a, "c2", "edmill");
  const double room = 0.08 * (chart.y.high - chart.y.low);
  chart.y.low -= room;
  chart.y.high += room;
  std::ostringstream out;
  plot::save(out, chart);
  return out.str();
}

}  // namespace edmill::app
