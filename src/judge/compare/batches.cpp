#include "compare/batches.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace edmill::compare {

std::size_t SpectrumClasses::of(double value) const {
  if (!(value > floor_)) return 0;
  const double octaves = std::log2(value / floor_);
  return octaves < 48 ? std::min(count - 1, 1 + static_cast<std::size_t>(16 * octaves)) : count - 1;
}

double Batch::all_events() const { return std::accumulate(events.begin(), events.end(), 0.0); }

std::vector<Batch> cut_into_batches(const std::filesystem::path& place, const BatchTimes& times, int walls,
                                    const SpectrumClasses& speed_classes,
                                    const SpectrumClasses& dose_classes) {
  std::vector<Batch> batches(times.count, Batch(walls));
  logs::EventLog log(place);
  const bool dose = log.has(model::milling_dose), work = log.has(model::wall_work);
  while (const auto event = log.next()) {
    const double place_in_time = (event->time - times.from) / times.length;
    if (place_in_time < 0) continue;
    if (!(place_in_time < static_cast<double>(times.count))) break;
    Batch& batch = batches[static_cast<std::size_t>(place_in_time)];
    (event->with_wall ? batch.events[event->partner] : batch.events.back()) += 1;
    batch.approach_speed += event->approach_speed;
    batch.spectra[event->with_wall ? wall_speeds : ball_speeds][speed_classes.of(event->approach_speed)] += 1;
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

SpectrumTest test_spectra(const std::vector<Batch>& a, const std::vector<Batch>& b, Spectrum spectrum) {
  // The permutations below use sums and differences. Classes that are empty in both logs are left out.
  std::vector<std::size_t> used;
  BatchValues both;
  for (std::size_t c = 0; c < SpectrumClasses::count; ++c) {
    double sum = 0;
    for (std::size_t k = 0; k < a.size(); ++k) sum += a[k].spectra[spectrum][c] + b[k].spectra[spectrum][c];
    if (sum != 0) {
      used.push_back(c);
      both.push_back(sum);
    }
  }
  std::vector<BatchValues> differences(a.size());
  for (std::size_t k = 0; k < a.size(); ++k)
    for (const auto c : used) differences[k].push_back(a[k].spectra[spectrum][c] - b[k].spectra[spectrum][c]);
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

}  // namespace edmill::compare
