#!/usr/bin/env bash
# Every header that users include compiles on its own, needs no header of src/, and states its subject in the first line.
# usage: headers_test.sh COMPILER
set -euo pipefail
cd "$(dirname "$0")/../.."
compiler=$1
status=0
for header in include/edmill/*.hpp; do
  for standard in gnu++20 c++20; do
    echo "#include \"${header#include/}\"" |
      "$compiler" -x c++ -std=$standard -Wall -Wextra -Werror -fsyntax-only -Iinclude - || {
      echo "$header does not compile on its own as $standard"
      status=1
    }
  done
  head -n 1 "$header" | grep -q '^// .*\.$' || {
    echo "$header: the first line does not state what it is for"
    status=1
  }
done
[ $status = 0 ] && echo "$(ls include/edmill/*.hpp | wc -l) headers compile on their own"
exit $status
