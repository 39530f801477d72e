#!/usr/bin/env bash
# A double run gives the same bits from g++ -O0, g++ -O3 -march=native and clang++ -O2, and from the program as it was
# built: the SHA-256 of the logs of 28 balls, which are all searched, of 600 in cells, and of 2000, with prefetching; and of a
# box that is shaken, which the general wall search serves; of a planetary jar with rounded edges; and of a vial with a piston,
# with several contact laws; of a sphere, a capsule in a drum and a polyhedron that a chain moves.
# usage: same_bits_test.sh PROGRAM FOLDER LIBRARY... -- FLAG...
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$1
builds=$2
shift 2
libraries=()
while [ "$1" != -- ]; do
  libraries+=("$1")
  shift
done
common=("${@:2}" -std=gnu++20 -Isrc -Iinclude -DEDMILL_WIDE_FROM_LIBRARY)
cases=("28 20000" "600 20000" "2000 20000" "box 4000" "planetary 4000" "materials 4000"
  "sphere 4000" "capsule 4000" "polyhedron 4000") # balls, collisions
small=(balls.0.diameter="2.36 mm" balls.0.gap_ball="0.2 mm" contact.restitution=0.8)

settings_of() { # balls
  settings=()
  case_file=docs/examples/demo.toml
  case $1 in
    28) ;;
    box) case_file=docs/examples/shaken_box.toml ;;
    sphere) settings=("mill={type=\"spex_2d\",speed=\"1054 rpm\"}" "vessel={type=\"sphere\",diameter=\"48 mm\"}") ;;
    capsule) settings=("mill={type=\"drum\",speed=\"120 rpm\"}" "vessel={type=\"capsule\",diameter=\"38 mm\",height=\"57 mm\"}") ;;
    polyhedron) settings=("mill={type=\"chain\",joint=[{rotate=\"z\",speed=\"300 rpm\"},{translate=\"x\",swing=[{amplitude=\"5 mm\",speed=\"1500 rpm\"}]}]}"
      "vessel={type=\"polyhedron\",vertex=[{at=[\"40 mm\",0,0]},{at=[\"-40 mm\",0,0]},{at=[0,\"40 mm\",0]},{at=[0,\"-40 mm\",0]},{at=[0,0,\"40 mm\"]},{at=[0,0,\"-40 mm\"]}]}") ;;
    planetary | materials) case_file=docs/examples/$1.toml ;;
    *) settings=("balls.0.count=$1" "${small[@]}") ;;
  esac
}

hash_of() { # name collisions log
  [ "$(wc -l <"$3")" = $(($2 + 1)) ] || {
    echo "$1: the log does not hold $2 collisions" >&2
    exit 1
  }
  sha256sum <"$3" | cut -d' ' -f1
}

# The engine in double, compiled by one compiler; the library reads the case, which computes with integers, and makes the
# decisions in wide scalars.
build() { # name compiler flags...
  local name=$1
  shift
  for source in tests/architecture/collision_bits.cpp src/engine/flight_columns.cpp; do
    "$@" "${common[@]}" -c "$source" -o "$builds/$name-$(basename "$source").o"
  done
  "$@" "$builds/$name"-*.o "${libraries[@]}" -lpugixml -lfmt -lmpfr -lgmp -lquadmath -lcrypto -lz -lzstd -ltomlplusplus -o "$builds/$name"
}

hash_of_build() { # name balls collisions
  settings_of "$2"
  "$builds/$1" "$case_file" "$3" "${settings[@]}" >"$builds/$1.csv"
  hash_of "$1" "$3" "$builds/$1.csv"
}

hash_of_program() { # balls collisions
  settings_of "$1"
  local given=()
  for setting in "${settings[@]}"; do given+=(--set "$setting"); done
  "$program" run "$case_file" --quiet --out "$builds/program" --set run.max_collisions="$2" \
    --set "output=[{type=\"collisions\"}]" "${given[@]}"
  hash_of program "$2" "$builds/program/collisions.csv"
}

rm -rf "$builds"
mkdir -p "$builds"
build gcc-O0 g++ -O0 &
build gcc-O3-native g++ -O3 -march=native
wait -n
# quadmath.h is GCC's; behind all other folders, so that Clang's own headers come first.
build clang-O2 clang++ -O2 -idirafter "$(g++ -print-file-name=include)"
different=0
for each in "${cases[@]}"; do
  read -r balls collisions <<<"$each"
  hashes=("$(hash_of_program "$balls" "$collisions")")
  for name in gcc-O0 gcc-O3-native clang-O2; do hashes+=("$(hash_of_build "$name" "$balls" "$collisions")"); done
  echo "$balls balls, the program            ${hashes[0]}"
  echo "$balls balls, g++ -O0                ${hashes[1]}"
  echo "$balls balls, g++ -O3 -march=native  ${hashes[2]}"
  echo "$balls balls, clang++ -O2            ${hashes[3]}"
  [ "$(printf '%s\n' "${hashes[@]}" | sort -u | wc -l)" = 1 ] || different=1
done
[ $different = 0 ] && echo "the logs have the same bits"
