# Headers of others that nearly every source includes, parsed once: more than half of the compile
# time went into them. Headers of edmill stay out, so that a change of one compiles what includes
# it. A source includes what it uses all the same.
option(EDMILL_PRECOMPILED "parse the headers of Eigen, Boost and others once for all sources" ON)

set(edmill_precompiled
    <algorithm> <array> <atomic> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numeric> <optional>
    <sstream> <string> <string_view> <type_traits> <utility> <variant> <vector>
    <boost/container/static_vector.hpp> <boost/math/tools/toms748_solve.hpp> <boost/multiprecision/eigen.hpp>
    <boost/multiprecision/float128.hpp> <boost/multiprecision/mpfr.hpp> <Eigen/Geometry> <fmt/format.h>)

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
