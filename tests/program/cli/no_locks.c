// flock as file systems have it that lock files alone, or nothing: NO_LOCKS is "folders" or "all".
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

int flock(int descriptor, int how) {
  const char* without = getenv("NO_LOCKS");
  struct stat status;
  if (without && fstat(descriptor, &status) == 0 &&
      (strcmp(without, "all") == 0 || S_ISDIR(status.st_mode))) {
    errno = strcmp(without, "all") == 0 ? ENOLCK : EBADF;
    return -1;
  }
  int (*real)(int, int) = (int (*)(int, int))dlsym(RTLD_NEXT, "flock");
  return real(descriptor, how);
}
