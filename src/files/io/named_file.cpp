#include "io/named_file.hpp"

#include "io/atomic_file.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

NamedFile::NamedFile(fs::path place) : place_(std::move(place)), through_(Destination(place_).through) {
  std::error_code ignored;
  if (place_.has_parent_path() ? fs::is_directory(place_.parent_path(), ignored) : true) lock();
}

void NamedFile::lock() {
  if (!through_ && !lock_)
    lock_.emplace(place_.has_parent_path() ? place_.parent_path() : ".", FolderLock::Kind::shared);
}

void NamedFile::write(const std::function<void(std::ostream&)>& put) {
  if (!through_ && place_.has_parent_path()) prepare_folder(place_.parent_path());
  lock();
  AtomicFile file(place_);
  put(file.stream());
  file.commit();
}

std::optional<NamedFile> file_for(const std::string& name) {
  if (name.empty()) return std::nullopt;
  return std::make_optional<NamedFile>(name);
}

}  // namespace edmill::io
