// The processes of a run under mpirun; a single one without it.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace edmill::study {

/// Starts MPI when an MPI launcher started the program, and ends it. At most one at a time.
class Ranks {
 public:
  Ranks();
  ~Ranks();
  Ranks(const Ranks&) = delete;
  Ranks& operator=(const Ranks&) = delete;

  int rank() const { return rank_; }
  int size() const { return size_; }

  void send(int to, const std::string& text) const;
  /// A message that has arrived, and its source; does not wait for one.
  std::optional<std::pair<int, std::string>> receive() const;

 private:
  int rank_ = 0, size_ = 1;
};

}  // namespace edmill::study
