#include "edmill/record/output_folder.hpp"

#include <unistd.h>

#include <atomic>

#include "edmill/core/errors.hpp"

namespace edmill::record {

namespace fs = std::filesystem;

void prepare_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder))
    throw InputError(folder.string() + ": found no folder and none can be made (" + error.message() +
                     "), expected an output folder");
  for (const auto* name : {"summary.json", "final_state.csv"})
    if (fs::is_directory(folder / name, error))
      throw InputError((folder / name).string() + ": found a folder, expected a place for a file");
  if (::access(folder.c_str(), W_OK | X_OK) != 0)
    throw InputError(folder.string() +
                     ": found a folder that cannot be written to, expected an output folder");
}

namespace {
std::atomic<int> opened = 0;  // two files of one run can have the same place

/// What stood in `place`, then what is in `addition`, under the latter's name.
void prepend(const fs::path& place, const fs::path& addition) {
  const fs::path joined = addition.string() + "-joined";
  std::ofstream out(joined, std::ios::binary | std::ios::trunc);
  for (const auto& part : {place, addition}) {
    std::ifstream in(part, std::ios::binary);
    if (fs::file_size(part) > 0) out << in.rdbuf();
  }
  out.close();
  if (out.fail()) {
    std::error_code ignored;
    fs::remove(joined, ignored);
    throw std::runtime_error(place.string() + ": could not be written; the disk may be full");
  }
  fs::rename(joined, addition);
}

}  // namespace

AtomicFile::AtomicFile(fs::path place, bool append)
    : place_(std::move(place)),
      temporary_(place_.string() + ".partial-" + std::to_string(::getpid()) + "-" + std::to_string(opened++)),
      append_(append) {
  std::error_code ignored;
  if (fs::is_directory(place_, ignored))
    throw InputError(place_.string() + ": found a folder, expected a place for a file");
  stream_.open(temporary_, std::ios::binary | std::ios::trunc);
  if (!stream_)
    throw InputError(place_.string() + ": found a file that cannot be written, expected a writable place");
}

AtomicFile::~AtomicFile() {
  if (committed_) return;
  stream_.close();
  std::error_code ignored;
  fs::remove(temporary_, ignored);
}

void AtomicFile::commit() {
  stream_.flush();
  const bool good = stream_.good();
  stream_.close();
  if (!good || stream_.fail())
    throw std::runtime_error(place_.string() + ": could not be written; the disk may be full");
  std::error_code ignored;
  if (append_ && fs::exists(place_, ignored)) prepend(place_, temporary_);
  fs::rename(temporary_, place_);
  committed_ = true;
}

}  // namespace edmill::record
