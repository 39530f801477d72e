#include "io/atomic_folder.hpp"

#include <algorithm>
#include <fstream>
#include <sstream>

#include "base/errors.hpp"
#include "io/file_buffer.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

/// What a link points to is written into, so that the link stays.
fs::path without_links(const fs::path& place) {
  std::error_code error;
  const auto found = fs::canonical(place, error);
  return error ? place : found;
}

}  // namespace

AtomicFolder::AtomicFolder(const fs::path& place)
    : named_(place), place_(without_links(place)), temporary_(temporary_name(place_)) {
  std::error_code ignored;
  if (fs::exists(place_, ignored) && !fs::is_directory(place_, ignored))
    throw InputError(place.string() + ": found a file, expected a place for a folder");
  prepare_folder(temporary_);
}

AtomicFolder::~AtomicFolder() {
  std::error_code ignored;
  if (!kept_) fs::remove_all(temporary_, ignored);  // absent after `commit`
}

void AtomicFolder::note(const std::string& name, const std::string& text) {
  names_.push_back(name);
  digest_.add(name + " " + std::to_string(text.size()) + "\n" + text);
}

void AtomicFolder::add(const std::string& name, const std::string& text) {
  write_plain(temporary_ / name, text);
  note(name, text);
}

void AtomicFolder::commit() {
  if (!fs::exists(place_)) return fs::rename(temporary_, place_);
  for (const auto& name : names_) fs::rename(temporary_ / name, place_ / name);
  fs::remove_all(temporary_);
}

std::vector<fs::path> AtomicFolder::places() const {
  std::vector<fs::path> places;
  for (const auto& name : names_) places.push_back(named_ / name);
  return places;
}

void AtomicFolder::archive(Archive& a) {
  std::string name = temporary_.filename().string(), digest = digest_.hex();
  auto files = a.loading() ? std::vector<std::string>{} : names_;
  if (!a.loading()) {
    for (; synced_ < names_.size(); ++synced_) sync_to_disk(temporary_ / names_[synced_]);
    sync_to_disk(temporary_);
  }
  a(name, files, digest);
  if (a.loading())
    go_on_from(name, files, digest);
  else
    kept_ = true;
}

void AtomicFolder::go_on_from(const std::string& name, const std::vector<std::string>& files,
                              const std::string& digest) {
  const fs::path fresh = temporary_;
  temporary_.replace_filename(temporary_name_from(name, place_));
  kept_ = fs::is_directory(temporary_);  // copies of committed files can be made again
  if (kept_)
    fs::remove(fresh);
  else
    fs::rename(fresh, temporary_);
  std::error_code ignored;
  for (const auto& file : files) {
    if (file.empty() || file.find('/') != std::string::npos || file == "." || file == "..")
      throw InputError(named_.string() + ": found '" + file +
                       "' in the checkpoint, expected the name of a frame");
    if (!fs::exists(temporary_ / file, ignored)) {
      // Whole or not at all: a resumed run may be killed here, too.
      const fs::path copy = temporary_name(temporary_ / file);
      fs::copy_file(place_ / file, copy, ignored);
      fs::rename(copy, temporary_ / file, ignored);
    }
    std::ifstream in(temporary_ / file, std::ios::binary);
    std::ostringstream text;
    if (in.peek() != std::ifstream::traits_type::eof()) text << in.rdbuf();
    note(file, text.str());
  }
  if (digest_.hex() != digest)
    throw InputError(named_.string() +
                     ": found other frames than the checkpoint was made with, expected the files as the run "
                     "left them");
  // Those that were added after the checkpoint come again.
  std::vector<fs::path> later;
  for (const auto& entry : fs::directory_iterator(temporary_))
    if (std::find(names_.begin(), names_.end(), entry.path().filename().string()) == names_.end())
      later.push_back(entry.path());
  for (const auto& file : later) fs::remove_all(file);
}

}  // namespace edmill::io
