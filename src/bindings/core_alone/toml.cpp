// toml++ is compiled here alone; elsewhere its headers only declare.
#define TOML_IMPLEMENTATION
#include <toml++/toml.h>
