// Where the bytes of a file go that somebody has named: into a new file that takes its place, or through it.
#pragma once

#include <filesystem>
#include <optional>

namespace edmill::io {

/// The number of this process's descriptor that a path names: /dev/stdout, /dev/fd/63, a link to one of them.
std::optional<int> descriptor_named(const std::filesystem::path& path);

/// A device, a pipe or a socket is written through. Anything else, also what a symbolic link points to, is
/// replaced by a file that was made beside it.
struct Destination {
  std::filesystem::path named, place;  ///< as given; with links followed
  bool through = false;

  /// @throws InputError for a folder and for links that lead nowhere
  explicit Destination(std::filesystem::path given);

  /// Where its file is made: beside the place, or among the system's temporary files if written through.
  std::filesystem::path temporary() const;
  /// A descriptor of what is written through, or -1 with errno.
  int open_through() const;
  /// Moves a complete file into place, or copies it through. @throws std::runtime_error
  void take(const std::filesystem::path& file) const;
};

}  // namespace edmill::io
