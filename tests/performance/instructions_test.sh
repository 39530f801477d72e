#!/usr/bin/env bash
# The count of instructions of a fixed short run is the recorded one within 2 %. Unlike a time it
# has no noise.
# usage: instructions_test.sh EDMILL [--update]
# The figure holds for g++ 12 in a Release build; anything else is skipped (exit code 77).
set -euo pipefail
program=$(realpath "$1")
cd "$(dirname "$0")/../.."
pinned_file=tests/performance/instructions.txt

skip() {
  echo "skipped: $*"
  exit 77
}
command -v valgrind >/dev/null || skip "valgrind is not installed"
grep -qw avx2 /proc/cpuinfo || skip "the figure is for a CPU with AVX2, whose loop the program picks"
[ "$(uname -m)" = x86_64 ] || skip "the figure is for x86_64, this is $(uname -m)"
compiler=$("$program" --version | sed -n 's/^compiler //p')
[[ $compiler =~ ^GNU\ 12\..*,\ Release$ ]] || skip "the figure is for GNU 12, Release; this is '$compiler'"

folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
# The libraries' baseline code on any CPU.
export GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX512F,-AVX512VL,-AVX2,-AVX,-FMA,-FMA4,-BMI1,-BMI2,-ERMS,-SSE4_2,-SSE4_1,-SSSE3
counted_up_to() { # collisions
  env -u LD_PRELOAD LC_ALL=C valgrind --tool=callgrind --callgrind-out-file="$folder/callgrind.out" \
    "$program" run docs/examples/demo.toml --quiet --out "$folder/out" --set run.start_time='"0 s"' \
    --set run.max_collisions="$1" >"$folder/log" 2>&1 || {
    cat "$folder/log" >&2
    exit 1
  }
  grep -q "\"total\": *$1\$" "$folder/out/summary.json" || {
    echo "the run did not end after $1 collisions:" >&2
    cat "$folder/out/summary.json" >&2
    exit 1
  }
  sed -n 's/^\(summary\|totals\): *\([0-9]*\).*/\2/p' "$folder/callgrind.out" | head -n 1
}
# The instructions of 4000 collisions: what loads libraries and reads the case does not count.
start=$(counted_up_to 1000)
whole=$(counted_up_to 5000)
counted=$((whole - start))
echo "counted $counted instructions"
if [ "${2:-}" = --update ]; then
  echo "$counted" >"$pinned_file"
  exit 0
fi
pinned=$(cat "$pinned_file")
echo "pinned  $pinned instructions"
awk -v counted="$counted" -v pinned="$pinned" 'BEGIN {
  change = counted / pinned - 1
  printf "change  %+.3f %%\n", 100 * change
  exit !(change <= 0.02 && change >= -0.02)
}' || {
  echo "more than 2 % off; if that is meant: tests/performance/instructions_test.sh PROGRAM --update"
  exit 1
}
