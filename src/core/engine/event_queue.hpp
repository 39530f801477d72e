// Events, and the queue of the next event of each ball, with the earliest on top.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <utility>
#include <vector>

#include "base/instant.hpp"
#include "base/memory.hpp"

namespace edmill::engine {

enum class EventKind {
  wall_contact,
  pair_contact,
  void_contact,   ///< a pair contact whose partner has had an impact since it was predicted
  cell_crossing,  ///< a ball leaves its cell of the grid
  wall_horizon,   ///< end of the window proven free of walls; the search continues here
};

template <class Real> struct Event {
  EventKind kind;
  Instant<Real> time;
  int ball;
  int partner = -1;      ///< a wall or a ball
  bool by_rule = false;  ///< a rule put it before another contact

  bool is_pair() const { return kind == EventKind::pair_contact; }
  bool involves(int other) const { return ball == other || (is_pair() && partner == other); }
  bool shares_ball(const Event& other) const {
    return involves(other.ball) || (other.is_pair() && involves(other.partner));
  }
  bool same_bodies(const Event& other) const {
    return kind == other.kind && bodies() == other.bodies();
  }
  /// The order of simultaneous contacts: walls before balls, then lower numbers first.
  bool goes_before(const Event& other) const {
    return std::pair(is_pair(), bodies()) < std::pair(other.is_pair(), other.bodies());
  }
 private:
  std::pair<int, int> bodies() const {
    return is_pair() ? std::minmax({ball, partner}) : std::pair(ball, partner);
  }
};

/// A calendar queue: each drive period is divided into days so short that few contain more than one
/// event. Days up to the horizon, three to four weeks ahead, have a list each. Later events are
/// noted for their week, without order, and put into lists when the horizon reaches it. So events
/// cost the same for any number of balls, and the lists fit into the near caches. A day of many
/// events, since balls share an instant, becomes a heap when it comes. Equal times are ordered by
/// the ball's number, whatever the history. (Brown 1988; Tang, Goh and Thng 2005)
template <class Real> class EventQueue {
 public:
  /// @param period  of the drive [s]
  EventQueue(int balls, const Real& period)
      : entries_(balls), heads_(list_count(entries_.size())), marks_(heads_.size() / 64),
        notes_(weeks), days_per_week_(static_cast<std::int64_t>(heads_.size() / 4)),
        days_per_second_(static_cast<double>(days_per_period_) / static_cast<double>(period)) {
    start_over(0);
  }

  /// The ball whose event is next.
  int top() {
    const std::int64_t begin = today_;
    today_ = next_occupied(today_);
    for (int opened = 0; horizon_ - today_ <= 3 * days_per_week_;
         ++opened, today_ = next_occupied(today_)) {
      if (opened < weeks)
        open_week();
      else
        start_over(earliest_day());
    }
    top_ = first_today();
    days_passed_ += std::min(today_ - begin, static_cast<std::int64_t>(heads_.size()));
    if (++taken_ >= review_) review();
    return top_;
  }

  const Instant<Real>& time(int ball) const { return entries_[ball].time; }

  /// The balls most likely to have the next three events after the last `top`, for prefetching.
  std::array<int, 3> upcoming() const {
    std::array<int, 3> balls{top_, top_, top_};
    std::int64_t day = today_;
    std::size_t found = 0;
    if (heap_.size() > 1)
      balls[found++] = heap_[1];
    else if (const int same_day = entries_[top_].next; same_day >= 0)
      balls[found++] = same_day;
    while (found < balls.size() && (day = next_occupied(day + 1)) < horizon_)
      balls[found++] = head(day);
    return balls;
  }

  void fetch_entry(int ball) const { fetch(&entries_[ball]); }

  void set(int ball, const Instant<Real>& time) {
    unlink(ball);
    entries_[ball].time = time;
    put(ball);
  }

  /// True if another ball than that of the last `top` has an event up to `limit`.
  bool has_more_until(const Instant<Real>& limit) const {
    const auto is_due = [&](int ball) { return ball != top_ && entries_[ball].time <= limit; };
    if (heap_.size() > 1) return is_due(heap_[1]) || (heap_.size() > 2 && is_due(heap_[2]));
    const bool alone = !heap_.empty() || (head(today_) == top_ && entries_[top_].next == none);
    if (alone && day_of(limit) <= today_) return false;
    const std::int64_t last = std::max(day_of(limit), today_);
    for (auto day = next_occupied(today_); day <= last && day < horizon_;
         day = next_occupied(day + 1))
      for (int i = head(day); i != none; i = entries_[i].next)
        if (is_due(i)) return true;
    for (int i = 0; last >= horizon_ && i < static_cast<int>(entries_.size()); ++i)
      if (is_due(i)) return true;
    return false;
  }
 private:
  static constexpr int none = -1, put_off = -2, in_heap = -3;  ///< special values of `Entry::next`
  static constexpr int crowd = 32;   ///< a day with more events becomes a heap
  static constexpr int weeks = 256;  ///< for which notes are kept
  static constexpr std::int64_t far_off = std::int64_t{1} << 30;  ///< [periods], in no run
  static constexpr std::int64_t no_day = std::int64_t{1} << 62;
  static constexpr std::int64_t most_days = std::int64_t{1} << 31;  ///< of a period

  struct Entry {
    Instant<Real> time = Instant<Real>::never();
    std::int64_t day = no_day;
    int next = put_off;
    /// The previous ball of the list. Of a postponed ball: the place of the week whose note is
    /// valid; older ones are void. Of a ball in the heap: its place there.
    int previous = none;
  };

  /// With few balls nearly all events are before the horizon; with many, most are within the weeks.
  static std::size_t list_count(std::size_t balls) {
    return std::bit_ceil(std::max(std::clamp<std::size_t>(8 * balls, 1024, 16384), balls / 8));
  }

  /// Never decreases with time, so that today can be emptied before tomorrow is searched.
  std::int64_t day_of(const Instant<Real>& time) const {
    if (time.period >= far_off) return no_day;
    const double place = static_cast<double>(time.offset) * days_per_second_;
    const auto day = static_cast<std::int64_t>(place);
    return time.period * days_per_period_ + (day < days_per_period_ ? day : days_per_period_ - 1);
  }
  std::int64_t week_of(std::int64_t day) const { return day >> week_shift_; }
  static int place_of(std::int64_t week) { return static_cast<int>(week & (weeks - 1)); }
  std::size_t list_of(std::int64_t day) const {
    return static_cast<std::size_t>(day) & (heads_.size() - 1);
  }
  int head(std::int64_t day) const { return heads_[list_of(day)]; }

  /// The first day from `day` on whose list is not empty, or the horizon. Tests a word of marks at
  /// a time: the end of a loop over empty lists would always be mispredicted.
  std::int64_t next_occupied(std::int64_t day) const {
    for (; day < horizon_; day = (day | 63) + 1) {
      const std::size_t at = list_of(day);
      const std::uint64_t marks = marks_[at / 64] >> (at % 64);
      if (marks != 0) return day + std::countr_zero(marks);
    }
    return horizon_;
  }

  /// @pre today has an event
  int first_today() {
    if (!heap_.empty()) return heap_.front();
    int best = none, count = 0;
    for (int i = head(today_); i != none; i = entries_[i].next, ++count)
      if (best == none || before(i, best)) best = i;
    if (count > crowd) [[unlikely]]
      fill_heap();
    return best;
  }

  bool before(int a, int b) const {
    const auto &one = entries_[a].time, &two = entries_[b].time;
    if (one < two) return true;
    return one == two && a < b;
  }

  void put(int ball) {
    Entry& e = entries_[ball];
    e.day = std::max(day_of(e.time), today_);
    if (!heap_.empty() && e.day == today_) [[unlikely]]
      push(ball);
    else if (e.day < horizon_) [[likely]]
      link(ball);
    else
      note(ball);
  }
  /// Not inlined, like the functions below: it would use registers that the common case needs.
  [[gnu::noinline]] void note(int ball) {
    Entry& e = entries_[ball];
    e.next = put_off;
    if (e.day == no_day) return;
    // Events beyond all weeks are noted in the last one and sorted again when it comes.
    const auto week = std::min(week_of(e.day), week_of(horizon_) + (weeks - 2));
    e.previous = place_of(week);
    notes_[e.previous].push_back(ball);
  }
  void link(int ball) {
    Entry& e = entries_[ball];
    const std::size_t list = list_of(e.day);
    int& first = heads_[list];
    marks_[list / 64] |= std::uint64_t{1} << (list % 64);
    e.previous = none;
    e.next = first;
    if (first != none) entries_[first].previous = ball;
    first = ball;
  }
  void unlink(int ball) {
    const Entry& e = entries_[ball];
    if (e.next < none) [[unlikely]]
      return e.next == in_heap ? pull(e.previous) : void();
    if (e.next != none) entries_[e.next].previous = e.previous;
    if (e.previous != none) {
      entries_[e.previous].next = e.next;
      return;
    }
    const std::size_t list = list_of(e.day);
    heads_[list] = e.next;
    marks_[list / 64] &= ~(std::uint64_t{e.next == none} << (list % 64));
  }

  // The heap of today's events, the earliest first. The day's mark is set while it is not empty.

  [[gnu::noinline]] void fill_heap() {
    for (int i = head(today_), next; i != none; i = next) {
      next = entries_[i].next;
      push(i);
    }
    heads_[list_of(today_)] = none;
  }
  [[gnu::noinline]] void push(int ball) {
    entries_[ball].next = in_heap;
    heap_.push_back(ball);
    rise(heap_.size() - 1, ball);
  }
  [[gnu::noinline]] void pull(int place) {
    const int last = heap_.back();
    heap_.pop_back();
    const auto at = static_cast<std::size_t>(place);
    if (at < heap_.size()) sink(rise(at, last), last);
    if (!heap_.empty()) return;
    const std::size_t list = list_of(today_);
    marks_[list / 64] &= ~(std::uint64_t{1} << (list % 64));
  }
  void set_place(std::size_t at, int ball) {
    heap_[at] = ball;
    entries_[ball].previous = static_cast<int>(at);
  }
  /// @return the new place of the ball
  std::size_t rise(std::size_t at, int ball) {
    for (; at > 0 && before(ball, heap_[(at - 1) / 2]); at = (at - 1) / 2)
      set_place(at, heap_[(at - 1) / 2]);
    set_place(at, ball);
    return at;
  }
  void sink(std::size_t at, int ball) {
    for (std::size_t child; (child = 2 * at + 1) < heap_.size(); at = child) {
      if (child + 1 < heap_.size() && before(heap_[child + 1], heap_[child])) ++child;
      if (!before(heap_[child], ball)) break;
      set_place(at, heap_[child]);
    }
    set_place(at, ball);
  }

  /// Moves the horizon by a week.
  [[gnu::noinline]] void open_week() {
    const int place = place_of(week_of(horizon_));
    auto& notes = notes_[place];
    horizon_ += days_per_week_;
    constexpr std::size_t ahead = 8;
    for (std::size_t k = 0; k < notes.size(); ++k) {
      if (k + ahead < notes.size()) fetch(&entries_[notes[k + ahead]]);
      const Entry& e = entries_[notes[k]];
      if (e.next != put_off || e.previous != place) continue;
      if (e.day < horizon_) [[likely]]
        link(notes[k]);
      else
        note(notes[k]);
    }
    notes.clear();
  }

  [[gnu::noinline]] void start_over(std::int64_t day) {
    std::fill(heads_.begin(), heads_.end(), none);
    std::fill(marks_.begin(), marks_.end(), 0);
    for (auto& notes : notes_) notes.clear();
    heap_.clear();
    today_ = day;
    horizon_ = (week_of(day) + 4) * days_per_week_;
    for (int i = 0; i < static_cast<int>(entries_.size()); ++i) put(i);
  }

  std::int64_t earliest_day() const {
    const auto earlier = [](const Entry& a, const Entry& b) { return a.day < b.day; };
    return std::min_element(entries_.begin(), entries_.end(), earlier)->day;
  }

  /// Adapts the length of days: longer if most days are empty, shorter if many events share one.
  void review() {
    const std::int64_t events = taken_, days = days_passed_, before = days_per_period_;
    taken_ = days_passed_ = 0;
    if (review_ < static_cast<std::int64_t>(entries_.size())) review_ *= 2;
    if (days > 6 * events) {
      for (auto d = days; d > 3 * events && days_per_period_ > 1; d /= 2) days_per_period_ /= 2;
    } else if (events > days) {
      for (auto d = days + 1; d < 2 * events && days_per_period_ < most_days; d *= 2)
        days_per_period_ *= 2;
    }
    if (days_per_period_ == before) return;
    days_per_second_ *= static_cast<double>(days_per_period_) / static_cast<double>(before);
    start_over(day_of(entries_[top_].time));
  }

  LargeVector<Entry> entries_;
  std::vector<int> heads_;            ///< of the lists of days
  std::vector<std::uint64_t> marks_;  ///< one for each list that is not empty
  std::vector<int> heap_;             ///< balls of today, in place of its list, when they are many
  std::vector<std::vector<int>> notes_;  ///< balls postponed to the weeks from the horizon on
  std::int64_t days_per_week_;           ///< a power of two
  int week_shift_ = std::countr_zero(static_cast<std::uint64_t>(days_per_week_));
  std::int64_t days_per_period_ = 1024;
  double days_per_second_;
  std::int64_t today_ = 0, horizon_ = 0;  ///< days, the latter the first of a week
  int top_ = none;
  std::int64_t taken_ = 0, days_passed_ = 0;  ///< since the last review
  std::int64_t review_ = 64;                  ///< after this many events; soon at first
};

}  // namespace edmill::engine
