// HDF5 files of a run, for tests.
#pragma once

#include <string>
#include <vector>

#include "io/hdf5_parts.hpp"

namespace edmill {

/// A dataset, as doubles.
inline std::vector<double> dataset(hid_t file, const std::string& name) {
  const io::Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose),
      space(H5Dget_space(set), H5Sclose);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  io::hdf5_check(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()));
  return values;
}

}  // namespace edmill
