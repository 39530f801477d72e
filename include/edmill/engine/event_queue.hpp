// The queue of next events: one entry for each ball, the earliest on top.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "edmill/core/instant.hpp"
#include "edmill/core/memory.hpp"

namespace edmill::engine {

/// A calendar: each drive period is cut into days, and the days are dealt round to lists, so short
/// that few hold more than one event. Taking the first event and setting one cost the same for any number of
/// balls. Equal times go to the lower ball, so the order of events does not depend on history. (Brown 1988)
template <class Real>
class EventQueue {
 public:
  /// @param period  of the drive [s]
  EventQueue(int balls, const Real& period)
      : entries_(balls),
        days_per_second_(static_cast<double>(days_per_period_) / static_cast<double>(period)) {
    std::size_t lists = 64;
    while (lists < 8 * entries_.size()) lists *= 2;
    heads_.assign(lists, none);
    occupied_.assign(lists / 64, 0);
    for (int i = 0; i < balls; ++i) link(i);
  }

  /// The ball whose event is next.
  int top() {
    const std::int64_t begin = today_;
    today_ = next_occupied(today_);
    while ((top_ = first_of(today_)) == none) {
      const bool all_seen = today_ - begin > static_cast<std::int64_t>(heads_.size());
      today_ = all_seen ? earliest_day() : next_occupied(today_ + 1);
    }
    days_passed_ += std::min(today_ - begin, static_cast<std::int64_t>(heads_.size()));
    if (++taken_ >= review_) review();
    return top_;
  }

  const Instant<Real>& time(int ball) const { return entries_[ball].time; }

  /// The balls of the next two events after that of the last `top`, most likely: a look at what may be
  /// fetched early, not an answer.
  std::array<int, 2> upcoming() const {
    const int same_day = entries_[top_].next;
    const auto day = next_occupied(today_ + 1);
    if (same_day != none) return {same_day, head(day)};
    return {head(day), head(next_occupied(day + 1))};
  }

  /// Asks memory for what `set` touches of a ball: its entry, and then the list that this is in.
  void fetch_entry(int ball) const { fetch(&entries_[ball]); }
  void fetch_list(int ball) const { fetch(&heads_[list_of(entries_[ball].day)]); }

  void set(int ball, const Instant<Real>& time) {
    unlink(ball);
    entries_[ball].time = time;
    link(ball);
  }

  /// The ball whose event is next after that of the last `top`, if it is not later than `limit`; -1
  /// otherwise.
  int runner_up(const Instant<Real>& limit) const {
    const std::int64_t last = std::max(day_of(limit), today_);
    const std::int64_t round = today_ + static_cast<std::int64_t>(heads_.size());
    for (auto day = next_occupied(today_); day <= last && day < round; day = next_occupied(day + 1)) {
      const int second = first_of(day, top_);
      if (second != none) return entries_[second].time <= limit ? second : none;
    }
    if (last < round) return none;
    int second = none;  // after a whole round without one
    for (int i = 0; i < static_cast<int>(entries_.size()); ++i)
      if (i != top_ && (second == none || before(i, second))) second = i;
    return second != none && entries_[second].time <= limit ? second : none;
  }

 private:
  static constexpr int none = -1;
  static constexpr std::int64_t far_off = std::int64_t{1} << 30;    ///< [periods], in no run
  static constexpr std::int64_t most_days = std::int64_t{1} << 31;  ///< of a period

  struct Entry {
    Instant<Real> time = Instant<Real>::never();
    std::int64_t day = 0;
    int next = none, previous = none;
  };

  /// Never later for an earlier time: `today` may be emptied before tomorrow is looked at.
  std::int64_t day_of(const Instant<Real>& time) const {
    if (time.period >= far_off) return std::int64_t{1} << 62;
    const double place = static_cast<double>(time.offset) * days_per_second_;
    const auto day = static_cast<std::int64_t>(place);
    return time.period * days_per_period_ + (day < days_per_period_ ? day : days_per_period_ - 1);
  }
  std::size_t list_of(std::int64_t day) const { return static_cast<std::size_t>(day) & (heads_.size() - 1); }
  int head(std::int64_t day) const { return heads_[list_of(day)]; }

  /// The first day from `day` on whose list is not empty: a word of marks at a time, since a loop over empty
  /// lists would end by surprise each time.
  std::int64_t next_occupied(std::int64_t day) const {
    for (;; day = (day | 63) + 1) {
      const std::size_t at = list_of(day);
      const std::uint64_t marks = occupied_[at / 64] >> (at % 64);
      if (marks != 0) return day + std::countr_zero(marks);
    }
  }

  /// A list holds the events of its day, and of days a round or more later.
  int first_of(std::int64_t day, int except = none) const {
    int best = none;
    for (int i = head(day); i != none; i = entries_[i].next)
      if (entries_[i].day == day && i != except && (best == none || before(i, best))) best = i;
    return best;
  }

  bool before(int a, int b) const {
    const auto &one = entries_[a].time, &two = entries_[b].time;
    if (one < two) return true;
    return one == two && a < b;
  }

  void link(int ball) {
    Entry& e = entries_[ball];
    const std::int64_t day = day_of(e.time);
    e.day = day < today_ ? today_ : day;
    const std::size_t list = list_of(e.day);
    int& first = heads_[list];
    occupied_[list / 64] |= std::uint64_t{1} << (list % 64);
    e.previous = none;
    e.next = first;
    if (first != none) entries_[first].previous = ball;
    first = ball;
  }
  void unlink(int ball) {
    const Entry& e = entries_[ball];
    if (e.next != none) entries_[e.next].previous = e.previous;
    if (e.previous != none) {
      entries_[e.previous].next = e.next;
      return;
    }
    const std::size_t list = list_of(e.day);
    heads_[list] = e.next;
    occupied_[list / 64] &= ~(std::uint64_t{e.next == none} << (list % 64));
  }

  std::int64_t earliest_day() const {
    const auto earlier = [](const Entry& a, const Entry& b) { return a.day < b.day; };
    return std::min_element(entries_.begin(), entries_.end(), earlier)->day;
  }

  /// Days get longer when most are empty and shorter when many events share one.
  void review() {
    const std::int64_t events = taken_, days = days_passed_, before = days_per_period_;
    taken_ = days_passed_ = 0;
    if (review_ < static_cast<std::int64_t>(entries_.size())) review_ *= 2;
    if (days > 6 * events) {
      for (auto d = days; d > 3 * events && days_per_period_ > 1; d /= 2) days_per_period_ /= 2;
    } else if (events > days) {
      for (auto d = days + 1; d < 2 * events && days_per_period_ < most_days; d *= 2) days_per_period_ *= 2;
    }
    if (days_per_period_ == before) return;
    days_per_second_ *= static_cast<double>(days_per_period_) / static_cast<double>(before);
    const int balls = static_cast<int>(entries_.size());
    std::fill(heads_.begin(), heads_.end(), none);
    std::fill(occupied_.begin(), occupied_.end(), 0);
    today_ = day_of(entries_[top_].time);
    for (int i = 0; i < balls; ++i) link(i);
  }

  LargeVector<Entry> entries_;
  LargeVector<int> heads_;
  std::vector<std::uint64_t> occupied_;  ///< a mark for each list that is not empty
  std::int64_t days_per_period_ = 1024;
  double days_per_second_;
  std::int64_t today_ = 0;
  int top_ = none;
  std::int64_t taken_ = 0, days_passed_ = 0;  ///< since the last review
  std::int64_t review_ = 64;                  ///< after so many events; soon at first, when nothing is known
};

}  // namespace edmill::engine
