#include "app/side_by_side.hpp"

#include <algorithm>
#include <future>

namespace edmill::app {

namespace {

/// Does both at a time. The second one's failure counts only where the first one has none.
template <class One, class Two>
auto together(const One& one, const Two& two) {
  auto later = std::async(std::launch::async, two);
  auto first = one();
  return std::pair{std::move(first), later.get()};
}

}  // namespace

SideBySide::SideBySide(const casefile::CaseSpec& spec, const std::string& narrow, const std::string& wide,
                       bool to_end, const std::atomic<bool>* interrupt)
    : interrupt_(interrupt), digits_{chosen_digits_of(narrow), chosen_digits_of(wide)} {
  std::tie(narrow_, wide_) = together([&] { return run::make_source(narrow, spec, to_end, interrupt); },
                                      [&] { return run::make_source(wide, spec, to_end, interrupt); });
}

std::vector<run::Event> SideBySide::next(std::size_t count) {
  if (diverged_ || uneven_) return {};
  auto [one, two] = together([&] { return narrow_->next(count); }, [&] { return wide_->next(count); });
  if (interrupt_ && *interrupt_) return {};
  const std::size_t shared = std::min(one.size(), two.size());
  std::size_t same = 0;
  while (same < shared && agreement_.take(one[same], two[same])) ++same;
  if (same < shared)
    diverged_ = {one[same], two[same]};
  else  // a wider scalar follows a collapse for some events more
    uneven_ = one.size() != two.size() && !narrow_->has_collapsed() && !wide_->has_collapsed();
  two.resize(same);
  drop_lost_digits();
  return std::move(two);
}

void SideBySide::drop_lost_digits() {
  constexpr double kept = 20;          // beyond those that are right
  constexpr double least = 50;         // in which the engine is tested most
  constexpr unsigned worthwhile = 20;  // about one limb of MPFR
  if (digits_[0] == 0 || digits_[1] == 0 || diverged_ || uneven_) return;
  const double needed = std::max(agreement_.least_digits() + kept, least);
  if (digits_[0] - needed < dropped_ + std::max(worthwhile, digits_[0] / 32)) return;
  dropped_ = static_cast<unsigned>(digits_[0] - needed);
  together([&] { return narrow_->continue_in(digits_[0] - dropped_), 0; },
           [&] { return wide_->continue_in(digits_[1] - dropped_), 0; });
}

double SideBySide::digits_of_states() const {
  const auto one = narrow_->states(), two = wide_->states();
  constexpr std::size_t kinds = 3, per_ball = 3 * kinds;
  std::array<run::Number, kinds> difference{}, size{};
  for (std::size_t k = 0; k < one.size(); ++k) {
    const std::size_t kind = k % per_ball / 3;
    difference[kind] = std::max(difference[kind], run::Number(abs(one[k] - two[k])));
    size[kind] = std::max(size[kind], run::Number(abs(two[k])));
  }
  double least = run::Agreement::most;
  for (std::size_t kind = 0; kind < kinds; ++kind)
    least = std::min(least, run::digits_of(difference[kind], size[kind]));
  return least;
}

}  // namespace edmill::app
