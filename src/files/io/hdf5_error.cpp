#include <cstdio>
#include <cstring>

#include "io/file_buffer.hpp"
#include "io/hdf5_parts.hpp"

namespace edmill::io {

namespace {

/// HDF5 keeps the error of the system only in texts of its stack: "errno = 27, error message = ...".
herr_t find_errno(unsigned, const H5E_error2_t* entry, void* error) {
  const char* text = entry->desc ? std::strstr(entry->desc, "errno = ") : nullptr;
  if (text) std::sscanf(text, "errno = %d", static_cast<int*>(error));
  return 0;
}

}  // namespace

Hdf5Error::Hdf5Error(int error)
    : std::runtime_error(not_written("HDF5 file", error).what()), system_error(error) {}

void throw_hdf5_error() {
  int error = 0;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, find_errno, &error);
  throw Hdf5Error(error);
}

}  // namespace edmill::io
