// Parts of HDF5 files, without dates: equal runs give equal bytes. Heavy: for sources only.
#pragma once

#include <hdf5.h>

#include <cstdio>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "io/atomic_file.hpp"
#include "io/table.hpp"

namespace edmill::io {

class Hdf5Error : public std::runtime_error {
 public:
  explicit Hdf5Error(int error)
      : std::runtime_error(not_written("HDF5 file", error).what()), system_error(error) {}
  const int system_error;  ///< errno; 0 when it is not known
};

/// @throws Hdf5Error with what HDF5 knows of its last failure
[[noreturn]] inline void throw_hdf5_error() {
  // HDF5 keeps the error of the system only in texts of its stack: "errno = 27, ...".
  const auto find_errno = [](unsigned, const H5E_error2_t* entry, void* error) -> herr_t {
    const char* text = entry->desc ? std::strstr(entry->desc, "errno = ") : nullptr;
    if (text) std::sscanf(text, "errno = %d", static_cast<int*>(error));
    return 0;
  };
  int error = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_errno, &error);
  throw Hdf5Error(error);
}

/// An HDF5 object, closed at the end of its scope.
class Handle {
 public:
  /// @throws std::runtime_error when `id` indicates a failure
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw_hdf5_error();
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }
 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// To be called before any other HDF5 function: failures become exceptions, and a file that could
/// not be written to a full disk is not closed again at the end of the program, which would crash.
inline void hdf5_begin() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// @throws std::runtime_error when a call has failed
inline void hdf5_check(herr_t status) {
  if (status < 0) throw_hdf5_error();
}

/// Creation properties of a new object without dates.
inline Handle undated(hid_t kind) {
  Handle creation(H5Pcreate(kind), H5Pclose);
  hdf5_check(H5Pset_obj_track_times(creation, false));
  return creation;
}

inline Handle text_type(std::size_t width) {
  Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  hdf5_check(H5Tset_size(type, width));
  hdf5_check(H5Tset_cset(type, H5T_CSET_UTF8));
  return type;
}

/// Writes a text as an attribute, of variable length so that readers return no bytes.
inline void note(hid_t object, const std::string& key, const std::string& value) {
  const Handle type = text_type(H5T_VARIABLE), space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(
      H5Acreate2(object, key.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  const char* text = value.c_str();
  hdf5_check(H5Awrite(attribute, type, &text));
}

/// A dataset that is written at once.
inline void add_set(
    hid_t file, const std::string& name, hid_t type, hid_t space, const void* values) {
  const Handle creation = undated(H5P_DATASET_CREATE);
  const Handle set(
      H5Dcreate2(file, name.c_str(), type, space, H5P_DEFAULT, creation, H5P_DEFAULT), H5Dclose);
  hdf5_check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values));
}

/// A text as a dataset.
inline void add_text(hid_t file, const std::string& name, const std::string& value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  add_set(file, name, text_type(value.size() + 1), space, value.c_str());
}

inline void add_notes(hid_t file, const std::vector<FileNote>& notes) {
  for (const auto& n : notes)
    n.long_text ? add_text(file, n.key, n.value) : note(file, n.key, n.value);
}

/// A dataset of rows of `width` values that can grow.
inline Handle make_set(hid_t group, const std::string& name, hid_t type, std::size_t width,
    hsize_t chunk, bool compressed) {
  const Handle creation = undated(H5P_DATASET_CREATE);
  const hsize_t size[2] = {0, width}, largest[2] = {H5S_UNLIMITED, width},
                chunks[2] = {chunk, width};
  const int rank = width > 1 ? 2 : 1;
  hdf5_check(H5Pset_chunk(creation, rank, chunks));
  if (compressed) {
    hdf5_check(H5Pset_shuffle(creation));
    hdf5_check(H5Pset_deflate(creation, 1));
  }
  const Handle space(H5Screate_simple(rank, size, largest), H5Sclose);
  // No cache: every chunk that is written goes to the file at once.
  const Handle access(H5Pcreate(H5P_DATASET_ACCESS), H5Pclose);
  hdf5_check(H5Pset_chunk_cache(access, 0, 0, 1));
  return {H5Dcreate2(group, name.c_str(), type, space, H5P_DEFAULT, creation, access), H5Dclose};
}

inline void append(hid_t set, hid_t memory_type, std::size_t width, hsize_t before, hsize_t rows,
    const void* values) {
  const int rank = width > 1 ? 2 : 1;
  const hsize_t size[2] = {before + rows, width}, start[2] = {before, 0}, count[2] = {rows, width};
  hdf5_check(H5Dset_extent(set, size));
  const Handle space(H5Dget_space(set), H5Sclose);
  hdf5_check(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, count, nullptr));
  const Handle memory(H5Screate_simple(rank, count, nullptr), H5Sclose);
  hdf5_check(H5Dwrite(set, memory_type, memory, space, H5P_DEFAULT, values));
}

inline Handle make_file(const std::filesystem::path& place) {
  const Handle creation = undated(H5P_FILE_CREATE);
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  // No lock of HDF5: nobody else knows the temporary file, and not every file system has locks.
  hdf5_check(H5Pset_file_locking(access, false, true));
  return {H5Fcreate(place.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose};
}

inline Handle make_group(hid_t file, const char* name) {
  const Handle creation = undated(H5P_GROUP_CREATE);
  return {H5Gcreate2(file, name, H5P_DEFAULT, creation, H5P_DEFAULT), H5Gclose};
}

/// Bytes of a file that `fill(file)` writes: in memory, so that they go to disk as one atomic file.
std::string hdf5_image(const auto& fill) {
  hdf5_begin();
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  hdf5_check(H5Pset_fapl_core(access, 1 << 16, false));
  const Handle creation = undated(H5P_FILE_CREATE);
  const Handle file(H5Fcreate("image.h5", H5F_ACC_TRUNC, creation, access), H5Fclose);
  fill(static_cast<hid_t>(file));
  hdf5_check(H5Fflush(file, H5F_SCOPE_GLOBAL));
  const auto size = H5Fget_file_image(file, nullptr, 0);
  if (size <= 0) throw std::runtime_error("HDF5 could not write a table");
  std::string image(static_cast<std::size_t>(size), '\0');
  if (H5Fget_file_image(file, image.data(), image.size()) != size)
    throw std::runtime_error("HDF5 could not write a table");
  return image;
}

}  // namespace edmill::io
