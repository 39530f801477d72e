// Common parts of everything that writes HDF5. Heavy: include it in source files only.
#pragma once

#include <hdf5.h>

#include <stdexcept>
#include <string>
#include <utility>

namespace edmill::io {

class Hdf5Error : public std::runtime_error {
 public:
  explicit Hdf5Error(int error);
  const int system_error;  ///< errno; 0 when it is not known
};

/// @throws Hdf5Error with what HDF5 knows of its last failure
[[noreturn]] void throw_hdf5_error();

/// An HDF5 object, closed at the end of its scope.
class Hdf5Handle {
 public:
  /// @throws std::runtime_error when `id` indicates a failure
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {
    if (id < 0) throw_hdf5_error();
  }
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

/// To be called before any other HDF5 function: failures become exceptions, and a file that could not be
/// written to a full disk is not closed again at the end of the program, which would crash.
inline void hdf5_begin() {
  static const herr_t once = H5dont_atexit();
  static_cast<void>(once);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

/// @throws std::runtime_error when a call has failed
inline void hdf5_check(herr_t status) {
  if (status < 0) throw_hdf5_error();
}

/// Bytes of a file that `fill(file)` writes: in memory, so that they go to disk as one atomic file.
template <class Fill>
std::string hdf5_image(Fill&& fill) {
  hdf5_begin();
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  hdf5_check(H5Pset_fapl_core(access, 1 << 16, false));
  const Hdf5Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose);
  hdf5_check(H5Pset_obj_track_times(creation, false));
  const Hdf5Handle file(H5Fcreate("image.h5", H5F_ACC_TRUNC, creation, access), H5Fclose);
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
