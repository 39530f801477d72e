// Kills the process before its N-th change to names of files, N from the variable DIES_AT.
#define _GNU_SOURCE
#include <dlfcn.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <unistd.h>

static void one_step(void) {
  static long done = 0;
  const char* wanted = getenv("DIES_AT");
  if (wanted && __atomic_add_fetch(&done, 1, __ATOMIC_SEQ_CST) == atol(wanted)) raise(SIGKILL);
}

#define STEP(name, parameters, arguments)         \
  int name parameters {                           \
    int(*original) parameters;                    \
    *(void**)&original = dlsym(RTLD_NEXT, #name); \
    one_step();                                   \
    return original arguments;                    \
  }

STEP(rename, (const char* from, const char* to), (from, to))
STEP(link, (const char* from, const char* to), (from, to))
STEP(unlink, (const char* path), (path))
STEP(remove, (const char* path), (path))
STEP(rmdir, (const char* path), (path))
STEP(unlinkat, (int folder, const char* path, int flags), (folder, path, flags))
