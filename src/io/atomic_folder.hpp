// A folder of files that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>

#include "base/archive.hpp"

namespace edmill::io {

/// Files are written into a temporary folder; `commit` replaces the old folder by it.
class AtomicFolder {
 public:
  /// @throws InputError when the temporary folder cannot be made
  explicit AtomicFolder(std::filesystem::path place);
  AtomicFolder(const AtomicFolder&) = delete;
  AtomicFolder& operator=(const AtomicFolder&) = delete;
  ~AtomicFolder();

  const std::filesystem::path& place() const { return place_; }
  /// Adds a file, or replaces it. @throws std::runtime_error when it was not written
  void add(const std::string& name, const std::string& text);
  void commit();

  /// For a checkpoint; the temporary folder is then kept even without `commit`. Files that were added
  /// later stay in it: a resumed run adds the same names again. Loading continues with that folder, or
  /// with a copy of the committed one when it is gone.
  void archive(Archive& a);

 private:
  std::filesystem::path place_, temporary_;
  bool kept_ = false;
};

}  // namespace edmill::io
