#!/usr/bin/env bash
# Every header that users include compiles on its own, needs no header of src/, and states its
# subject in the first line; together they compile without extensions of the language, too. With
# clang++, which has no quadmath.h, edmill.hpp compiles as well.
# usage: headers_test.sh COMPILER
set -euo pipefail
cd "$(dirname "$0")/../.."
compiler=$1
status=0
compiles() { # standard header...
  printf '#include "%s"\n' "${@:2}" | "$compiler" -x c++ "-std=$1" -Wall -Wextra -Werror -fsyntax-only -Iinclude - && return
  echo "does not compile as $1: ${*:2}"
  status=1
}
compiles c++20 $(cd include && ls edmill/*.hpp)
if command -v clang++ >/dev/null; then
  compiler=clang++ compiles c++20 edmill/edmill.hpp
else
  echo "skipped: clang++ is not installed"
fi
for header in include/edmill/*.hpp; do
  compiles gnu++20 "${header#include/}"
  head -n 1 "$header" | grep -q '^// .*\.$' || {
    echo "$header: the first line does not state what it is for"
    status=1
  }
done
[ $status = 0 ] && echo "$(ls include/edmill/*.hpp | wc -l) headers compile on their own"
exit $status
