// A log divided into batches of equal duration, and tests on two series of batches.
#pragma once

#include <filesystem>
#include <vector>

#include "logs/event_log.hpp"

namespace edmill::compare {

/// Batch k covers [from + k length, from + (k + 1) length). [s]
struct BatchTimes {
  double from = 0, length = 0;
  std::size_t count = 0;

  double until() const { return from + static_cast<double>(count) * length; }
};

/// Classes of a spectrum on a logarithmic scale, 16 an octave. Values up to `floor` share the first class:
/// rounding noise around zero is not resolved.
class SpectrumClasses {
 public:
  static constexpr std::size_t count = 1 + 16 * 48;
  explicit SpectrumClasses(double floor) : floor_(floor) {}
  std::size_t of(double value) const;

 private:
  double floor_;
};

/// Number of impacts by approach speed, on walls and between balls; milling dose by dose of the impact. The
/// dose has a spectrum of its own because mills have many impacts of negligible dose, whose number varies
/// much.
enum Spectrum : std::size_t { wall_speeds, ball_speeds, doses };
inline constexpr std::size_t spectrum_count = 3;

/// Totals of one batch.
struct Batch {
  std::vector<double> events;              ///< with each wall, and last between balls
  double approach_speed = 0;               ///< sum [m/s]
  double milling_dose = 0, wall_work = 0;  ///< [J]
  std::array<std::vector<double>, spectrum_count> spectra;

  explicit Batch(int walls = 0) : events(walls + 1) {
    spectra.fill(std::vector<double>(SpectrumClasses::count));
  }

  double all_events() const;
};

/// Divides a log into batches, in a second pass. Memory does not depend on its length.
/// @param walls  number of walls, larger than every wall number in the log
std::vector<Batch> cut_into_batches(const std::filesystem::path& place, const BatchTimes& times, int walls,
                                    const SpectrumClasses& speed_classes,
                                    const SpectrumClasses& dose_classes);

/// Values of a quantity, one per batch.
using BatchValues = std::vector<double>;

/// Batch values whose plain mean is sum / number of the whole and whose scatter is that of this ratio, to
/// first order (the linearised ratio estimator).
/// @pre the numbers are not all 0
BatchValues ratio_values(const BatchValues& sums, const BatchValues& numbers);

/// Largest distance between the distribution functions of two spectra, with a permutation test over batches.
struct SpectrumTest {
  double distance = 0;     ///< Kolmogorov's, over the bounds of the classes
  double limit = 0;        ///< exceeded in 5 % of the permutations
  double probability = 1;  ///< of at least this distance when A and B are alike
};

/// Each of 9999 permutations swaps batch k of A and B, or not, at random for every k; seeded, so that the
/// same logs give the same result. @pre as many batches in A as in B, and both spectra are not empty
SpectrumTest test_spectra(const std::vector<Batch>& a, const std::vector<Batch>& b, Spectrum spectrum);

}  // namespace edmill::compare
