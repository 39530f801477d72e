// LAMMPS's own library, loaded when the program runs: edmill builds without it.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace edmill::verification {

/// The C interface of LAMMPS (its `library.h`), as far as it is needed here.
class Lammps {
 public:
  /// Called at every step with the time step, the number of balls, their ids, positions [m] and
  /// forces to be added [N].
  using Callback = void (*)(
      void* self, std::int64_t step, int count, int* ids, double** x, double** forces);

  /// Where `dlopen` finds the library; empty when it is absent.
  static bool present();
  /// A new instance without any output. @throws std::runtime_error when the library is absent or
  /// unfit
  Lammps();
  ~Lammps();
  Lammps(const Lammps&) = delete;
  Lammps& operator=(const Lammps&) = delete;

  int version() const { return version_(handle_); }
  /// One command of an input script. LAMMPS ends the program when the command is wrong.
  void command(const std::string& text) { command_(handle_, text.c_str()); }
  /// A value of each ball; the pointer holds until LAMMPS enlarges its arrays.
  double** vectors(const char* name) { return static_cast<double**>(extract_(handle_, name)); }
  /// A row of a fix for each ball, null before there is one.
  double** rows_of_fix(const std::string& name) {
    constexpr int by_ball = 1, array = 2;
    return static_cast<double**>(extract_fix_(handle_, name.c_str(), by_ball, array, 0, 0));
  }
  double* numbers(const char* name) { return static_cast<double*>(extract_(handle_, name)); }
  void set_callback(const char* fix, Callback callback, void* self) {
    set_callback_(handle_, fix, callback, self);
  }
 private:
  struct Closer {
    void operator()(void* library) const;
  };
  template <class Function> void find(Function& function, const char* name);

  std::unique_ptr<void, Closer> library_;
  void* handle_ = nullptr;
  void* (*open_)(int, char**, void**) = nullptr;
  void (*close_)(void*) = nullptr;
  int (*version_)(void*) = nullptr;
  char* (*command_)(void*, const char*) = nullptr;
  void* (*extract_)(void*, const char*) = nullptr;
  void* (*extract_fix_)(void*, const char*, int, int, int, int) = nullptr;
  void (*set_callback_)(void*, const char*, Callback, void*) = nullptr;
};

}  // namespace edmill::verification
