// Files of one output in a folder of their own, which appear together or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/archive.hpp"
#include "base/digest.hpp"

namespace edmill::io {

/// Files are written into a temporary folder; `commit` moves them into place. Other files stay.
class AtomicFolder {
 public:
  /// @throws InputError when the temporary folder cannot be made
  explicit AtomicFolder(const std::filesystem::path& place);
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;
  ~AtomicFolder();

  const std::filesystem::path& place() const { return named_; }
  /// Adds a file. @throws std::runtime_error when it was not written
  void add(const std::string& name, const std::string& text);
  void commit();
  std::vector<std::filesystem::path> places() const;

  /// For a checkpoint; the temporary folder is then kept even without `commit`. Loading continues with
  /// exactly the files that were added so far, from that folder, or from where they were committed.
  /// @throws InputError when one is gone or has other content
  void archive(Archive& a);

 private:
  void note(const std::string& name, const std::string& text);
  void go_on_from(const std::string& name, const std::vector<std::string>& files, const std::string& digest);

  std::filesystem::path named_, place_, temporary_;  ///< as given; with links followed; until `commit`
  std::vector<std::string> names_;
  std::size_t synced_ = 0;  ///< of the names
  Sha256 digest_;           ///< of names and texts
  bool kept_ = false;
};

}  // namespace edmill::io
