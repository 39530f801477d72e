// A file whose name a user has given, for one result: `--out`, `--json`, `--draw`, `--certificate`.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <ostream>
#include <string>

#include "io/output_folder.hpp"

namespace edmill::io {

/// To be made before the work whose result it takes: a folder that a run writes into is refused early.
class NamedFile {
 public:
  /// @throws InputError when a run is being written into its folder
  explicit NamedFile(std::filesystem::path place);

  /// Writes the whole file, and makes the folders above it when they are absent.
  /// @throws InputError when it cannot be made, std::runtime_error when anything was not written
  void write(const std::function<void(std::ostream&)>& put);

 private:
  void lock();

  std::filesystem::path place_;
  bool through_;
  std::optional<FolderLock> lock_;
};

/// The file of that name; none where it is empty.
std::optional<NamedFile> file_for(const std::string& name);

}  // namespace edmill::io
