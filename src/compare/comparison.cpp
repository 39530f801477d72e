#include "compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "base/statistics.hpp"
#include "model/parts/partners.hpp"

namespace edmill::compare {

namespace {

/// Both scans, or the problems of both.
std::pair<LogScan, LogScan> scan_both(const Options& options) {
  std::vector<std::string> problems;
  const auto scan = [&](const std::filesystem::path& place) {
    try {
      return scan_log(place);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
      return LogScan{};
    }
  };
  auto a = scan(options.a), b = scan(options.b);
  if (!problems.empty()) throw InputError(problems);
  return {std::move(a), std::move(b)};
}

/// @throws InputError when the logs, or the options, leave no time in common
BatchTimes common_times(const LogScan& a, const LogScan& b, const Options& options) {
  if (a.events == 0 || b.events == 0) return {};
  const auto& limits = options.limits;
  double from = std::max(a.first, b.first), until = std::min(a.last, b.last);
  if (from > until)
    throw InputError(
        fmt::format("{} covers {:g} s to {:g} s and {} covers {:g} s to {:g} s, expected logs with "
                    "time in common",
                    a.file, a.first, a.last, b.file, b.first, b.last));
  if (limits.from)
    from = std::max(from, *limits.from);
  else
    for (const auto& start : {a.statistics_start, b.statistics_start})
      from = std::max(from, start.value_or(from));
  if (limits.until) until = std::min(until, *limits.until);
  if ((limits.from || limits.until) && from > until)
    throw InputError(
        fmt::format("--from, --until: found limits that leave nothing of {:g} s to {:g} s, which both "
                    "logs cover",
                    std::max(a.first, b.first), std::min(a.last, b.last)));
  if (!(until > from)) return {};
  const double span = until - from, length = options.batch.value_or(span / 20);
  // Rounding must not cost the last batch.
  const double count = std::floor(span / length * (1 + 1e-12));
  if (!(count >= fewest_batches && count <= most_batches))
    throw InputError(fmt::format("--batch: found {:g} s, {:g} batches in {:g} s to {:g} s, expected {} to {}",
                                 length, count, from, until, fewest_batches, most_batches));
  return {from, length, static_cast<std::size_t>(count)};
}

template <class Get>
BatchValues values_of(const std::vector<Batch>& batches, const Get& get) {
  BatchValues values;
  for (const auto& batch : batches) values.push_back(get(batch));
  return values;
}

Quantity named(const std::string& name, const std::string& unit) {
  Quantity q;
  q.name = name, q.unit = unit;
  return q;
}

/// Makes the rows of the table; the verdicts follow when all rows exist.
class Judge {
 public:
  Judge(const std::vector<Batch>& a, const std::vector<Batch>& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {}

  /// A mean over the batches. @param events  that it rests on, in A and B together
  void mean(const std::string& name, const std::string& unit, double events, const BatchValues& a,
            const BatchValues& b) {
    Quantity q = named(name, unit);
    BatchValues differences;
    for (std::size_t k = 0; k < a.size(); ++k) differences.push_back(b[k] - a[k]);
    const auto of_a = numerics::estimate(a), of_b = numerics::estimate(b),
               of_both = numerics::estimate(differences);
    q.a = of_a.mean, q.a_half_width = of_a.half_width;
    q.b = of_b.mean, q.b_half_width = of_b.half_width;
    q.difference = of_both.mean, q.half_width = of_both.half_width;
    // The tolerance on single events also applies to their mean.
    const double scale = std::max(std::abs(*q.a), std::abs(*q.b));
    const bool within = std::abs(*q.difference) <= tolerance_ * scale;
    add(std::move(q), events, within ? 1 : paired_t_probability(differences));
  }

  void spectrum(const std::string& name, Spectrum spectrum, double events) {
    const auto empty = [&](const std::vector<Batch>& batches) {
      return std::all_of(batches.begin(), batches.end(), [&](const Batch& batch) {
        const auto& values = batch.spectra[spectrum];
        return std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
      });
    };
    if (empty(a_) || empty(b_)) {
      skip(name, "1", "no impacts in one log");
      return;
    }
    Quantity q = named(name, "1");
    const auto test = test_spectra(a_, b_, spectrum);
    q.difference = test.distance, q.half_width = test.limit;
    add(std::move(q), events, test.probability);
  }

  void skip(const std::string& name, const std::string& unit, const std::string& reason) {
    Quantity q = named(name, unit);
    q.reason = reason;
    rows_.push_back(std::move(q));
  }

  /// @param same  every event agrees, so there is nothing to test
  std::vector<Quantity> rows(bool same) {
    BatchValues tested;
    for (const auto& q : rows_)
      if (q.probability) tested.push_back(*q.probability);
    const auto adjusted = holm(tested);
    auto next = adjusted.begin();
    for (auto& q : rows_) {
      if (same && q.verdict != Verdict::not_compared) {
        q.probability.reset();
        q.verdict = Verdict::agree;
      }
      if (!q.probability) continue;
      q.probability = *next++;
      q.verdict = *q.probability <= significance ? Verdict::differ : Verdict::agree;
    }
    return std::move(rows_);
  }

  static double events(const std::vector<Batch>& batches) {
    double sum = 0;
    for (const auto& batch : batches) sum += batch.all_events();
    return sum;
  }

 private:
  void add(Quantity q, double events, double probability) {
    q.verdict = Verdict::too_few;
    if (events >= fewest_events_per_batch * static_cast<double>(a_.size())) q.probability = probability;
    rows_.push_back(std::move(q));
  }

  const std::vector<Batch>&a_, &b_;
  double tolerance_;
  std::vector<Quantity> rows_;
};

std::vector<Quantity> judge(const Comparison& c) {
  // Spectra in classes above what counts as 0: far below the mean, and within the tolerance.
  const double zero = std::max(c.options.tolerance, 1e-9);
  const SpectrumClasses speed_classes(zero * c.a.mean_magnitude[model::approach_speed]);
  const SpectrumClasses dose_classes(zero * c.a.mean_magnitude[model::milling_dose]);
  const int walls = std::max(c.a.walls, c.b.walls);
  const auto a = cut_into_batches(c.options.a, c.times, walls, speed_classes, dose_classes);
  const auto b = cut_into_batches(c.options.b, c.times, walls, speed_classes, dose_classes);
  Judge judge(a, b, c.options.tolerance);
  const double length = c.times.length, all = Judge::events(a) + Judge::events(b);

  const auto events_with = [&](int partner) {
    double sum = 0;
    for (const auto* batches : {&a, &b})
      for (const auto& batch : *batches) sum += batch.events[partner];
    return sum;
  };
  for (int k = 0; k <= walls; ++k) {
    const auto rate = [&](const Batch& batch) { return batch.events[k] / length; };
    const double events = events_with(k);
    const auto name = "collision_rate_" + model::partner_key(k, walls);
    if (events > 0)
      judge.mean(name, "1/s", events, values_of(a, rate), values_of(b, rate));
    else
      judge.skip(name, "1/s", "no such collisions");
  }
  const auto missing = [&](std::size_t v) {
    return "no " + std::string(model::logged_quantities[v].name) + (c.a.has[v] ? " in B" : " in A");
  };
  const auto power = [&](std::size_t v, const std::string& name, double Batch::*energy) {
    const auto rate = [&](const Batch& batch) { return batch.*energy / length; };
    if (c.a.has[v] && c.b.has[v])
      judge.mean(name, "W", all, values_of(a, rate), values_of(b, rate));
    else
      judge.skip(name, "W", missing(v));
  };
  power(model::milling_dose, "milling_dose_rate", &Batch::milling_dose);
  power(model::wall_work, "wall_work_rate", &Batch::wall_work);
  const auto speed = [](const Batch& batch) { return batch.approach_speed; };
  const auto events = [](const Batch& batch) { return batch.all_events(); };
  if (Judge::events(a) > 0 && Judge::events(b) > 0)
    judge.mean("mean_approach_speed", "m/s", all, ratio_values(values_of(a, speed), values_of(a, events)),
               ratio_values(values_of(b, speed), values_of(b, events)));
  else
    judge.skip("mean_approach_speed", "m/s", "no collisions in one log");
  const double between_balls = events_with(walls);
  judge.spectrum("wall_approach_speed_spectrum", wall_speeds, all - between_balls);
  judge.spectrum("ball_approach_speed_spectrum", ball_speeds, between_balls);
  if (c.a.has[model::milling_dose] && c.b.has[model::milling_dose])
    judge.spectrum("milling_dose_spectrum", doses, all);
  else
    judge.skip("milling_dose_spectrum", "1", missing(model::milling_dose));
  return judge.rows(c.events.agree_throughout());
}

Verdict whole(const Comparison& c) {
  const auto any = [&](Verdict verdict) {
    return c.events_verdict == verdict ||
           std::any_of(c.quantities.begin(), c.quantities.end(),
                       [&](const Quantity& q) { return q.verdict == verdict; });
  };
  if (any(Verdict::differ)) return Verdict::differ;
  if (c.events_verdict != Verdict::too_few && c.events.agree_throughout()) return Verdict::agree;
  if (c.times.count == 0 || any(Verdict::too_few)) return Verdict::too_few;
  return Verdict::agree;
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  static constexpr std::array<std::string_view, 4> names = {"agree", "differ", "too_few", "not_compared"};
  return names[static_cast<std::size_t>(verdict)];
}

Comparison compare(const Options& options) {
  Comparison c;
  c.options = options;
  std::tie(c.a, c.b) = scan_both(options);
  c.times = common_times(c.a, c.b, options);
  c.events = compare_events(options.a, options.b, c.a, c.b, options.limits, options.tolerance);
  if (options.events) {
    const bool enough = c.events.agreeing >= *options.events;
    c.events_verdict = enough ? Verdict::agree : c.events.first ? Verdict::differ : Verdict::too_few;
  }
  if (c.times.count > 0) c.quantities = judge(c);
  c.verdict = whole(c);
  return c;
}

}  // namespace edmill::compare
