#!/usr/bin/env bash
# Every header compiles on its own.
# usage: headers_test.sh COMPILER [FLAGS...]
set -euo pipefail
cd "$(dirname "$0")/../.."
compiler=$1
shift
status=0
check() {
  local header=$1
  shift
  echo "#include \"${header#src/}\"" | "$@" -x c++ -std=gnu++20 -fsyntax-only -Isrc - || {
    echo "$header does not compile on its own"
    return 1
  }
}
export -f check
find src -name '*.hpp' | sort | xargs -P 2 -I{} bash -c 'check "$@"' _ {} "$compiler" "$@" || status=1
[ $status = 0 ] && echo "$(find src -name '*.hpp' | wc -l) headers compile on their own"
exit $status
