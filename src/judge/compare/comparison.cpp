#include "compare/comparison.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <random>

#include "base/errors.hpp"
#include "base/statistics.hpp"

namespace edmill::compare {

std::size_t SpectrumClasses::of(double value) const {
  if (!(value > floor_)) return 0;
  const double octaves = std::log2(value / floor_);
  return octaves < 48 ? std::min(count - 1, 1 + static_cast<std::size_t>(16 * octaves)) : count - 1;
}

Batches cut_into_batches(const std::filesystem::path& place, const BatchTimes& times, int walls,
    const SpectrumClasses& speed_classes, const SpectrumClasses& dose_classes) {
  Batches batches(times.count, Batch(walls));
  logs::EventLog log(place);
  const bool dose = log.has(model::milling_dose), work = log.has(model::wall_work);
  while (const auto event = log.next()) {
    const double place_in_time = (event->time - times.from) / times.length;
    if (place_in_time < 0) continue;
    if (!(place_in_time < static_cast<double>(times.count))) break;
    Batch& batch = batches[static_cast<std::size_t>(place_in_time)];
    (event->with_wall ? batch.events[event->partner] : batch.events.back()) += 1;
    batch.approach_speed += event->approach_speed;
    batch.spectra[event->with_wall ? wall_speeds : ball_speeds]
                 [speed_classes.of(event->approach_speed)] += 1;
    if (dose) {
      batch.milling_dose += event->milling_dose;
      batch.spectra[doses][dose_classes.of(event->milling_dose)] += event->milling_dose;
    }
    if (work) batch.wall_work += event->wall_work;
  }
  return batches;
}

BatchValues ratio_values(const BatchValues& sums, const BatchValues& numbers) {
  const double sum = std::accumulate(sums.begin(), sums.end(), 0.0);
  const double number = std::accumulate(numbers.begin(), numbers.end(), 0.0);
  const double ratio = sum / number, mean_number = number / static_cast<double>(numbers.size());
  BatchValues values(sums.size());
  for (std::size_t k = 0; k < sums.size(); ++k)
    values[k] = ratio + (sums[k] - ratio * numbers[k]) / mean_number;
  return values;
}

SpectrumTest test_spectra(const Batches& a, const Batches& b, Spectrum spectrum) {
  // The permutations use sums and differences. Classes that are empty in both are left out.
  std::vector<std::size_t> used;
  BatchValues both;
  for (std::size_t c = 0; c < SpectrumClasses::count; ++c) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k)
      sum += a[k].spectra[spectrum][c] + b[k].spectra[spectrum][c];
    if (sum == 0) continue;
    used.push_back(c);
    both.push_back(sum);
  }
  std::vector<BatchValues> differences(a.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    for (const auto c : used)
      differences[k].push_back(a[k].spectra[spectrum][c] - b[k].spectra[spectrum][c]);
  const double all = std::accumulate(both.begin(), both.end(), 0.0);

  // With s the sum of +-(A - B): A has (both + s)/2, B (both - s)/2.
  BatchValues s(used.size());
  const auto distance = [&](auto&& sign_of) {
    std::fill(s.begin(), s.end(), 0.0);
    for (std::size_t k = 0; k < differences.size(); ++k) {
      const double sign = sign_of(k);
      for (std::size_t c = 0; c < s.size(); ++c) s[c] += sign * differences[k][c];
    }
    const double excess = std::accumulate(s.begin(), s.end(), 0.0);
    if (std::abs(excess) >= all) return 1.0;  // one log is empty
    double up_to_a = 0, up_to_b = 0, largest = 0;
    for (std::size_t c = 0; c < s.size(); ++c) {
      up_to_a += (both[c] + s[c]) / (all + excess);
      up_to_b += (both[c] - s[c]) / (all - excess);
      largest = std::max(largest, std::abs(up_to_a - up_to_b));
    }
    return largest;
  };

  constexpr std::size_t exchanges = 9999;
  SpectrumTest test;
  test.distance = distance([](std::size_t) { return 1.0; });
  std::mt19937_64 random(20110101);
  BatchValues distances;
  std::size_t as_far = 1;  // the observed assignment counts too
  for (std::size_t e = 0; e < exchanges; ++e) {
    std::uint64_t bits = 0;
    distances.push_back(distance([&](std::size_t k) {
      if (k % 64 == 0) bits = random();
      return (bits >> (k % 64)) & 1 ? 1.0 : -1.0;
    }));
    // Swapping all batches or none gives the same distance up to the rounding of sums.
    if (distances.back() >= test.distance * (1 - 1e-12)) ++as_far;
  }
  test.probability = static_cast<double>(as_far) / (exchanges + 1);
  std::sort(distances.begin(), distances.end());
  test.limit = distances[static_cast<std::size_t>(0.95 * exchanges)];
  return test;
}

namespace {

/// @throws InputError when the logs, or the options, leave no time in common
BatchTimes common_times(const LogScan& a, const LogScan& b, const ComparisonOptions& options) {
  if (a.events == 0 || b.events == 0) return {};
  const auto& limits = options.limits;
  double from = std::max(a.first, b.first), until = std::min(a.last, b.last);
  if (from > until)
    throw InputError(
        fmt::format("{} covers {:g} s to {:g} s and {} covers {:g} s to {:g} s: the logs have no "
                    "time in common",
            a.file, a.first, a.last, b.file, b.first, b.last));
  if (limits.from)
    from = std::max(from, *limits.from);
  else
    for (const auto& start : {a.statistics_start, b.statistics_start})
      from = std::max(from, start.value_or(from));
  if (limits.until) until = std::min(until, *limits.until);
  if ((limits.from || limits.until) && from > until)
    throw InputError(fmt::format(
        "--from, --until: these limits leave nothing of {:g} s to {:g} s, which both logs cover",
        std::max(a.first, b.first), std::min(a.last, b.last)));
  if (!(until > from)) return {};
  const double span = until - from, length = options.batch.value_or(span / 20);
  // Rounding must not cost the last batch.
  const double count = std::floor(span / length * (1 + 1e-12));
  if (!(count >= fewest_batches && count <= most_batches))
    throw InputError(fmt::format(
        "--batch: found {:g} s, {:g} batches in {:g} s to {:g} s, expected {} to {} batches",
        length, count, from, until, fewest_batches, most_batches));
  return {from, length, static_cast<std::size_t>(count)};
}

std::optional<logs::LoggedEvent> next_within(logs::EventLog& reader, const Limits& limits) {
  auto event = reader.next();
  while (event && limits.from && event->time < *limits.from) event = reader.next();
  if (event && limits.until && event->time > *limits.until) return std::nullopt;
  return event;
}

/// Compares the events of both logs one by one. Differences of a value are relative to its
/// magnitude in A, or to the mean magnitude of its column in A if that is larger.
/// @param c  has the options and both scans. @throws InputError when a log cannot be read
EventComparison compare_events(const Comparison& c) {
  logs::EventLog log_a(c.options.a), log_b(c.options.b);
  const Limits& limits = c.options.limits;
  EventComparison result;
  numerics::Line growth;
  for (;;) {
    const auto a = next_within(log_a, limits), b = next_within(log_b, limits);
    if (!a || !b) break;  // events beyond the end of either log are not compared
    if (!a->same_bodies(*b)) {
      if (!result.first)
        result.first = {*a, *b, "partners", std::numeric_limits<double>::quiet_NaN()};
      break;
    }
    ++result.same_partners;
    if (result.first) continue;
    OfEach<double> difference{};
    for (std::size_t v = 0; v < model::logged_count; ++v) {
      if (!c.a.has[v] || !c.b.has[v]) continue;
      const double scale = std::max(std::abs((*a)[v]), c.a.mean_magnitude[v]);
      const double distance = std::abs((*a)[v] - (*b)[v]);
      if (distance > 0)
        difference[v] = scale > 0 ? distance / scale : std::numeric_limits<double>::infinity();
    }
    const auto worst = std::max_element(difference.begin(), difference.end());
    if (*worst > c.options.event_tolerance()) {
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

template <class Get> BatchValues values_of(const Batches& batches, const Get& get) {
  BatchValues values;
  for (const auto& batch : batches) values.push_back(std::invoke(get, batch));
  return values;
}

/// Makes the rows of the table; the verdicts follow when all rows exist.
class Quantities {
 public:
  Quantities(const Batches& a, const Batches& b, double tolerance)
      : a_(a), b_(b), tolerance_(tolerance) {}

  /// Adds the mean of a quantity over the batches.
  /// @param reason     why it cannot be compared, or empty
  /// @param events     number of events that it is based on, in A and B together
  /// @param get        its value in a batch
  /// @param per_event  true if that value is a sum over events and the mean per event is compared
  void mean(const std::string& name, const std::string& unit, const std::string& reason,
      double events, const auto& get, bool per_event = false) {
    if (!reason.empty()) return skip(name, unit, reason);
    const auto values_in = [&](const Batches& batches) {
      const auto values = values_of(batches, get);
      return per_event ? ratio_values(values, values_of(batches, &Batch::all_events)) : values;
    };
    const BatchValues a = values_in(a_), b = values_in(b_);
    BatchValues differences(a.size());
    std::transform(b.begin(), b.end(), a.begin(), differences.begin(), std::minus());
    const auto of_a = numerics::estimate(a), of_b = numerics::estimate(b);
    const auto of_both = numerics::estimate(differences);
    // The tolerance on single events also applies to their mean.
    const double scale = std::max(std::abs(*of_a.mean), std::abs(*of_b.mean));
    const bool within = std::abs(*of_both.mean) <= tolerance_ * scale;
    add({.name = name,
            .unit = unit,
            .a = of_a.mean,
            .b = of_b.mean,
            .a_half_width = of_a.half_width,
            .b_half_width = of_b.half_width,
            .difference = of_both.mean,
            .half_width = of_both.half_width},
        events, within ? 1 : numerics::paired_t_probability(differences));
  }

  void spectrum(const std::string& name, const std::string& reason, Spectrum which, double events) {
    if (!reason.empty()) return skip(name, "1", reason);
    const auto empty = [&](const Batches& batches) {
      return std::all_of(batches.begin(), batches.end(), [&](const Batch& batch) {
        const auto& values = batch.spectra[which];
        return std::all_of(values.begin(), values.end(), [](double v) { return v == 0; });
      });
    };
    if (empty(a_) || empty(b_)) return skip(name, "1", "no impacts in one log");
    const auto test = test_spectra(a_, b_, which);
    add({.name = name, .unit = "1", .difference = test.distance, .half_width = test.limit}, events,
        test.probability);
  }

  /// @param same  every event agrees, so there is nothing to test
  std::vector<Quantity> rows(bool same) {
    BatchValues tested;
    for (const auto& q : rows_)
      if (q.probability) tested.push_back(*q.probability);
    const auto adjusted = numerics::holm(tested);
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
 private:
  void skip(const std::string& name, const std::string& unit, const std::string& reason) {
    rows_.push_back({.name = name, .unit = unit, .reason = reason});
  }
  void add(Quantity q, double events, double probability) {
    q.verdict = Verdict::too_few;
    if (events >= fewest_events_per_batch * static_cast<double>(a_.size()))
      q.probability = probability;
    rows_.push_back(std::move(q));
  }

  const Batches &a_, &b_;
  double tolerance_;
  std::vector<Quantity> rows_;
};

std::vector<Quantity> judge(const Comparison& c) {
  // Values up to this fraction of the mean count as 0 in spectra: at least the tolerance of events.
  const double zero = std::max(c.options.event_tolerance(), 1e-9);
  const SpectrumClasses speed_classes(zero * c.a.mean_magnitude[model::approach_speed]);
  const SpectrumClasses dose_classes(zero * c.a.mean_magnitude[model::milling_dose]);
  const int walls = std::max(c.a.walls, c.b.walls);
  const auto a = cut_into_batches(c.options.a, c.times, walls, speed_classes, dose_classes);
  const auto b = cut_into_batches(c.options.b, c.times, walls, speed_classes, dose_classes);
  Quantities quantities(a, b, c.options.event_tolerance());
  const auto sum_of = [](const Batches& batches, const auto& get) {
    const auto values = values_of(batches, get);
    return std::accumulate(values.begin(), values.end(), 0.0);
  };
  const double of_a = sum_of(a, &Batch::all_events), of_b = sum_of(b, &Batch::all_events),
               all = of_a + of_b;
  const double length = c.times.length;

  double between_balls = 0;  // after the loop: they are the last partner
  for (int k = 0; k <= walls; ++k) {
    const auto with_partner = [k](const Batch& batch) { return batch.events[k]; };
    between_balls = sum_of(a, with_partner) + sum_of(b, with_partner);
    quantities.mean("collision_rate_" + model::partner_key(k, walls), "1/s",
        between_balls > 0 ? "" : "no such collisions", between_balls,
        [&](const Batch& batch) { return batch.events[k] / length; });
  }
  const auto missing = [&](std::size_t v) {
    if (c.a.has[v] && c.b.has[v]) return std::string();
    return "no " + std::string(model::logged_quantities[v].name) + (c.a.has[v] ? " in B" : " in A");
  };
  const auto power = [&](std::size_t v, const std::string& name, double Batch::*energy) {
    quantities.mean(name, "W", missing(v), all, [&](auto& b) { return b.*energy / length; });
  };
  power(model::milling_dose, "milling_dose_rate", &Batch::milling_dose);
  power(model::wall_work, "wall_work_rate", &Batch::wall_work);
  quantities.mean("mean_approach_speed", "m/s",
      of_a > 0 && of_b > 0 ? "" : "no collisions in one log", all, &Batch::approach_speed, true);
  quantities.spectrum("wall_approach_speed_spectrum", "", wall_speeds, all - between_balls);
  quantities.spectrum("ball_approach_speed_spectrum", "", ball_speeds, between_balls);
  quantities.spectrum("milling_dose_spectrum", missing(model::milling_dose), doses, all);
  return quantities.rows(c.events.agree_throughout());
}

}  // namespace

std::string_view name_of(Verdict verdict) {
  return std::array{"agree", "differ", "too_few", "not_compared"}.at(
      static_cast<std::size_t>(verdict));
}

Comparison compare(const ComparisonOptions& options) {
  Comparison c;
  c.options = options;
  std::vector<std::string> problems;  // of both logs
  for (const auto& [place, scan] : {std::pair{&options.a, &c.a}, {&options.b, &c.b}}) {
    try {
      *scan = logs::scan_log(*place);
    } catch (const InputError& error) {
      problems.insert(problems.end(), error.problems().begin(), error.problems().end());
    }
  }
  if (!problems.empty()) throw InputError(problems);
  c.times = common_times(c.a, c.b, options);
  c.events = compare_events(c);
  if (options.events) {
    const bool enough = c.events.agreeing >= *options.events;
    c.events_verdict = enough ? Verdict::agree
        : c.events.first      ? Verdict::differ
                              : Verdict::too_few;
  }
  if (c.times.count > 0) c.quantities = judge(c);
  const auto any = [&](Verdict verdict) {
    const auto is_such = [&](const Quantity& q) { return q.verdict == verdict; };
    return c.events_verdict == verdict ||
        std::any_of(c.quantities.begin(), c.quantities.end(), is_such);
  };
  const bool agree = c.events_verdict != Verdict::too_few && c.events.agree_throughout();
  const bool too_few = !agree && (c.times.count == 0 || any(Verdict::too_few));
  c.verdict = any(Verdict::differ) ? Verdict::differ : too_few ? Verdict::too_few : Verdict::agree;
  return c;
}

}  // namespace edmill::compare
