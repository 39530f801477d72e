#!/usr/bin/env bash
# A double run gives the same bits from g++ -O0, g++ -O3 -march=native and clang++ -O2, and from the program as it was
# built: the SHA-256 of a log of 20 000 collisions.
# usage: same_bits_test.sh PROGRAM FOLDER
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$1
builds=$2
case_file=docs/examples/demo.toml

hash_of() { # name log
  [ "$(wc -l <"$2")" = 20001 ] || {
    echo "$1: the log does not hold 20000 collisions" >&2
    exit 1
  }
  sha256sum <"$2" | cut -d' ' -f1
}

hash_of_build() { # name compiler flags
  local folder="$builds/$1"
  cmake -S . -B "$folder" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$2" -DCMAKE_CXX_FLAGS="$3" \
    -DEDMILL_BENCHMARKS=OFF >"$builds/$1.log" 2>&1 &&
    cmake --build "$folder" --target collision_bits >>"$builds/$1.log" 2>&1 || {
    tail -n 30 "$builds/$1.log" >&2
    exit 1
  }
  "$folder/tests/collision_bits" "$case_file" 20000 >"$folder/collisions.csv"
  hash_of "$1" "$folder/collisions.csv"
}

mkdir -p "$builds"
"$program" run "$case_file" --quiet --out "$builds/program" --set run.max_collisions=20000 \
  --set "output=[{type=\"collisions\"}]"
hashes=(
  "$(hash_of program "$builds/program/collisions.csv")"
  "$(hash_of_build gcc-O0 g++ "-O0")"
  "$(hash_of_build gcc-O3-native g++ "-O3 -march=native")"
  "$(hash_of_build clang-O2 clang++ "-O2")"
)
echo "the program            ${hashes[0]}"
echo "g++ -O0                ${hashes[1]}"
echo "g++ -O3 -march=native  ${hashes[2]}"
echo "clang++ -O2            ${hashes[3]}"
[ "$(printf '%s\n' "${hashes[@]}" | sort -u | wc -l)" = 1 ] && echo "the logs have the same bits"
