# Headers that nearly every source includes, parsed once: more than half of the compile time went into them. For the core these
# are headers of others, so that a change of one of edmill compiles what includes it. What stands around the core sees all of it,
# and its instances in every scalar, which take longer than the rest together. A source includes what it uses all the same.
option(EDMILL_PRECOMPILED "parse headers that nearly every source includes once for all sources" ON)

set(edmill_precompiled
    <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numeric> <optional>
    <sstream> <string> <string_view> <type_traits> <utility> <variant> <vector>
    <boost/container/static_vector.hpp> <boost/math/tools/toms748_solve.hpp> <boost/multiprecision/eigen.hpp>
    <boost/multiprecision/float128.hpp> <boost/multiprecision/mpfr.hpp> <Eigen/Geometry> <fmt/format.h>)

set(edmill_instances ${CMAKE_SOURCE_DIR}/src/instances/tools/instances.hpp)

# edmill_precompile(target HEADERS header...): these headers and those above.
function(edmill_precompile target)
  cmake_parse_arguments(ARG "" "" "HEADERS" ${ARGN})
  if(EDMILL_PRECOMPILED)
    target_precompile_headers(${target} PRIVATE ${edmill_precompiled} ${ARG_HEADERS})
  endif()
endfunction()

# edmill_reuse_precompiled(target from)
function(edmill_reuse_precompiled target from)
  if(EDMILL_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM ${from})
  endif()
endfunction()
