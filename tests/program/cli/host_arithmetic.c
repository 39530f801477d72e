/* A library that makes its host round as HOST_ARITHMETIC says, before anything else of it runs. */
#define _GNU_SOURCE
#include <fenv.h>
#include <stdlib.h>
#include <string.h>
#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

__attribute__((constructor)) static void begin(void) {
  const char* mode = getenv("HOST_ARITHMETIC");
  if (!mode) return;
  if (!strcmp(mode, "up")) fesetround(FE_UPWARD);
  if (!strcmp(mode, "down")) fesetround(FE_DOWNWARD);
  if (!strcmp(mode, "zero")) fesetround(FE_TOWARDZERO);
  if (!strcmp(mode, "traps")) feenableexcept(FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW);
#if defined(__SSE2__)
  if (!strcmp(mode, "flush")) _mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}
