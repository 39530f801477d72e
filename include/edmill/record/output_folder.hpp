// Files that appear whole or not at all.
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

namespace edmill::record {

/// Makes the folder, with its parents, when it is absent.
/// @throws InputError when it cannot be made or written to
void prepare_folder(const std::filesystem::path& folder);

/// A file that is written under a temporary name beside its place and put there by `commit`. Without it, the
/// file that stood there stays as it was.
class AtomicFile {
 public:
  /// @param append  what stands there when the file is put in place is kept before it
  /// @throws InputError when the temporary file cannot be opened
  explicit AtomicFile(std::filesystem::path place, bool append = false);
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;
  ~AtomicFile();

  std::ostream& stream() { return stream_; }

  /// @throws std::runtime_error when anything was not written; the old file is then still there
  void commit();

 private:
  std::filesystem::path place_, temporary_;
  std::ofstream stream_;
  bool append_, committed_ = false;
};

}  // namespace edmill::record
