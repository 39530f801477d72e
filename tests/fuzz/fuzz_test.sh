#!/usr/bin/env bash
# Builds the fuzz targets and searches for inputs that break them: SECONDS for each, two at a time.
# usage: fuzz_test.sh BUILD SECONDS TARGET...
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$1
seconds=$2
shift 2
command -v clang++ >/dev/null || {
  echo "skipped: needs clang"
  exit 77
}
optimisation=-O0 # of a short search compiling is most
[ "$seconds" -lt 60 ] || optimisation=-O1
cmake --preset fuzz -B "$build" -DEDMILL_FUZZ_OPTIMISATION=$optimisation >/dev/null
cmake --build "$build" --parallel 2 --target "${@/#/fuzz_}" >"$build.log" || {
  tail -n 30 "$build.log" >&2
  exit 1
}
search() { # target
  local found=$build/found/$1 log=$build/$1.log
  local longest=10
  [ "$1" != identify ] || longest=100 # it searches
  mkdir -p "$found/corpus"
  if "$build/tests/fuzz/fuzz_$1" -seed=20110101 -max_total_time="$seconds" -max_len=8192 -timeout=$longest -rss_limit_mb=2048 \
    -artifact_prefix="$found/" -print_final_stats=1 "$found/corpus" "tests/fuzz/corpus/${1%_without_arb}" >"$log" 2>&1; then
    echo "$1: $(sed -n 's/^stat::number_of_executed_units: *//p' "$log") inputs, 0 findings"
  else
    tail -n 40 "$log" >&2
    echo "$1: a finding, kept in $found" >&2
    return 1
  fi
}
export -f search
export build seconds
printf '%s\n' "$@" | xargs -P 2 -I {} bash -c 'search {}'
rm -rf "${TMPDIR:-/tmp}"/edmill-fuzz-*
