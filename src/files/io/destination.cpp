#include "io/destination.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>

#include "base/errors.hpp"
#include "io/file_buffer.hpp"
#include "io/output_folder.hpp"

namespace edmill::io {

namespace fs = std::filesystem;

namespace {

bool all_digits(const std::string& text) {
  return !text.empty() && text.size() < 10 && text.find_first_not_of("0123456789") == std::string::npos;
}

/// Calls visit(path) for a path and for what links make of it, until it answers true or no link is left.
/// @return false when the links do not end
bool follow(fs::path path, const auto& visit) {
  std::error_code error;
  for (int link = 0; link < 40; ++link) {
    if (visit(path) || !fs::is_symlink(fs::symlink_status(path, error))) return true;
    const auto target = fs::read_symlink(path, error);
    if (error) return true;
    path = target.is_absolute() ? target : path.parent_path() / target;
  }
  return false;
}

}  // namespace

std::optional<int> descriptor_named(const fs::path& path) {
  std::optional<int> number;
  const auto own = "/proc/" + std::to_string(::getpid()) + "/fd";
  follow(path, [&](const fs::path& p) {
    const auto folder = p.parent_path(), name = p.filename();
    if (all_digits(name.string()) && (folder == "/dev/fd" || folder == "/proc/self/fd" ||
                                      folder == "/proc/thread-self/fd" || folder == own))
      number = std::stoi(name.string());
    return number.has_value();
  });
  return number;
}

Destination::Destination(fs::path given) : named(std::move(given)), place(named) {
  std::error_code error;
  through = descriptor_named(named).has_value();
  if (through) return;
  const auto status = fs::status(named, error);
  if (fs::is_directory(status))
    throw InputError(named.string() + ": found a folder, expected a place for a file");
  through = fs::exists(status) && !fs::is_regular_file(status);
  if (!through && !follow(named, [&](const fs::path& p) { return place = p, false; }))
    throw InputError(named.string() + ": found links that lead to each other, expected a place for a file");
}

fs::path Destination::temporary() const {
  return temporary_name(through ? fs::temp_directory_path() / "edmill" : place);
}

int Destination::open_through() const {
  const auto number = descriptor_named(named);
  if (!number) return open_for_writing(named, 0);
  // The descriptor itself: a file that is opened again would be written from its beginning.
  if (*number == STDOUT_FILENO) std::fflush(stdout);
  return ::fcntl(*number, F_DUPFD_CLOEXEC, 3);
}

void Destination::take(const fs::path& file) const {
  if (!through) {
    std::error_code error;
    fs::rename(file, place, error);
    if (error) throw not_written(place, error.value());
    return;
  }
  FileBuffer out;
  const int descriptor = open_through();
  if (descriptor < 0) throw not_written(named, errno);
  out.open(descriptor);
  std::ifstream in(file, std::ios::binary);
  std::ostream stream(&out);
  if (in.peek() != std::ifstream::traits_type::eof()) stream << in.rdbuf();
  if (!out.close() || in.bad()) throw_not_written(named, out.error());
  fs::remove(file);
}

}  // namespace edmill::io
