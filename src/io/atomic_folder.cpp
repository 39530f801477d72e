#include "io/atomic_folder.hpp"

#include <fstream>

#include "base/errors.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

AtomicFolder::AtomicFolder(fs::path place) : place_(std::move(place)), temporary_(temporary_name(place_)) {
  prepare_folder(temporary_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!kept_) fs::remove_all(temporary_, ignored);  // absent after `commit`
}

void AtomicFolder::add(const std::string& name, const std::string& text) {
  std::ofstream file(temporary_ / name, std::ios::binary | std::ios::trunc);
  file << text;
  file.close();
  if (!file) throw std::runtime_error(place_.string() + ": could not be written; the disk may be full");
}

void AtomicFolder::commit() {
  fs::remove_all(place_);
  fs::rename(temporary_, place_);
}

void AtomicFolder::archive(Archive& a) {
  std::string name = temporary_.filename().string();
  a(name);
  kept_ = true;
  if (!a.loading()) return;

  fs::remove_all(temporary_);
  const fs::path copy = temporary_;
  temporary_.replace_filename(temporary_name_from(name, place_));
  if (fs::is_directory(temporary_)) return;
  if (!fs::is_directory(place_))
    throw InputError(place_.string() + ": found no folder, expected the frames that the run left");
  fs::copy(place_, copy);
  fs::rename(copy, temporary_);
}

}  // namespace edmill::io
