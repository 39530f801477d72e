// Only this source compiles toml++; elsewhere its headers contain only declarations.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
