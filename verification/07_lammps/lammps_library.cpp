#include "lammps_library.hpp"

#include <dlfcn.h>

#include <stdexcept>

namespace edmill::verification {
namespace {

/// Debian's package lammps brings this one.
constexpr const char* library_name = "liblammps.so.0";

}  // namespace

void Lammps::Closer::operator()(void*) const {}  // MPI inside it does not survive being unloaded

bool Lammps::present() { return dlopen(library_name, RTLD_NOW | RTLD_GLOBAL) != nullptr; }

template <class Function> void Lammps::find(Function& function, const char* name) {
  function = reinterpret_cast<Function>(dlsym(library_.get(), name));
  if (!function) throw std::runtime_error(std::string(library_name) + " has no " + name);
}

Lammps::Lammps() : library_(dlopen(library_name, RTLD_NOW | RTLD_GLOBAL)) {
  if (!library_) throw std::runtime_error("no " + std::string(library_name));
  find(open_, "lammps_open_no_mpi");
  find(close_, "lammps_close");
  find(version_, "lammps_version");
  find(command_, "lammps_command");
  find(extract_, "lammps_extract_atom");
  find(extract_fix_, "lammps_extract_fix");
  find(set_callback_, "lammps_set_fix_external_callback");
  std::string words[] = {"lammps", "-log", "none", "-screen", "none", "-nocite"};
  char* arguments[6];
  for (int i = 0; i < 6; ++i) arguments[i] = words[i].data();
  handle_ = open_(6, arguments, nullptr);
  if (!handle_) throw std::runtime_error("LAMMPS does not start");
}

Lammps::~Lammps() { close_(handle_); }

}  // namespace edmill::verification
