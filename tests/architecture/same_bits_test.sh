#!/usr/bin/env bash
# A double run gives the same bits from g++ -O0, g++ -O3 -march=native and clang++ -O2: the SHA-256 of a log of
# 20 000 collisions.
# usage: same_bits_test.sh [BUILD_FOLDER]
set -euo pipefail
cd "$(dirname "$0")/../.."
builds=${1:-build/same-bits}
case_file=docs/examples/demo.toml

hash_of() { # name compiler flags
  local folder="$builds/$1"
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$2" -DCMAKE_CXX_FLAGS="$3" \
    -DEDMILL_TESTS=OFF -DEDMILL_BENCHMARKS=OFF >"$builds/$1.log" 2>&1 &&
    cmake --build "$folder" --target edmill_cli >>"$builds/$1.log" 2>&1 || {
    tail -n 30 "$builds/$1.log" >&2
    exit 1
  }
  "$folder/edmill" run "$case_file" --quiet --out "$folder/out" --set run.max_collisions=20000 \
    --set "output=[{type=\"collisions\"}]"
  [ "$(wc -l <"$folder/out/collisions.csv")" = 20001 ] || {
    echo "$1: the log does not hold 20000 collisions" >&2
    exit 1
  }
  sha256sum <"$folder/out/collisions.csv" | cut -d' ' -f1
}

mkdir -p "$builds"
first=$(hash_of gcc-O0 g++ "-O0")
second=$(hash_of gcc-O3-native g++ "-O3 -march=native")
third=$(hash_of clang-O2 clang++ "-O2")
echo "g++ -O0                $first"
echo "g++ -O3 -march=native  $second"
echo "clang++ -O2            $third"
[ "$first" = "$second" ] && [ "$first" = "$third" ] && echo "the logs have the same bits"
