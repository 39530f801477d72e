#!/usr/bin/env bash
# The changes shown in docs/extending.md apply to the tree, and what they add works.
# usage: extending_test.sh FOLDER COMPILER
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$1
compiler=$2
rm -rf "$folder"
mkdir -p "$folder"
cp -r CMakeLists.txt README.md cmake src include docs tests verification regression "$folder"
sed -n '/^```diff$/,/^```$/{/^```/!p}' docs/extending.md >"$folder/change.diff"
grep -q '^+' "$folder/change.diff" || {
  echo "docs/extending.md shows no change" >&2
  exit 1
}
(cd "$folder" && patch -p1 --forward --fuzz=0 <change.diff)

# The core and the outputs in double are enough: collision_bits prints the log of a run.
cmake -S "$folder" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS=-O0 \
  -DEDMILL_BENCHMARKS=OFF >"$folder/log" 2>&1 && cmake --build "$folder/build" --target collision_bits \
  CMakeFiles/edmill_tools.dir/src/instances/tools/double.cpp.o CMakeFiles/edmill_core.dir/src/instances/mpfr80.cpp.o >>"$folder/log" 2>&1 || {
  tail -n 30 "$folder/log" >&2
  exit 1
}
for model in power walton-braun; do
  log=$folder/$model.csv
  "$folder/build/tests/collision_bits" docs/examples/demo.toml 50 "contact.model=$model" >"$log"
  [ "$(wc -l <"$log")" = 51 ] || {
    echo "model = \"$model\": the log does not hold 50 collisions" >&2
    exit 1
  }
done
if cmp -s "$folder/power.csv" "$folder/walton-braun.csv"; then
  echo "model = \"power\" gives the same run as walton-braun" >&2
  exit 1
fi
if "$folder/build/tests/collision_bits" docs/examples/demo.toml 50 contact.model=power contact.restitution=2 2>"$folder/error"; then
  echo "a restitution of 2 is accepted" >&2
  exit 1
fi
grep -q "key 'contact.restitution'" "$folder/error" || {
  echo "a restitution of 2 is refused without naming the key" >&2
  exit 1
}
for parts in "vessel={type=\"edged_jar\",side=\"34 mm\",height=\"57 mm\"}" "mill={type=\"turntable\",speed=\"300 rpm\"}" \
  "output=[{type=\"hardest\"}]"; do
  "$folder/build/tests/collision_bits" docs/examples/demo.toml 50 "$parts" >"$folder/parts.csv"
  [ "$(wc -l <"$folder/parts.csv")" = 51 ] || {
    echo "$parts: the log does not hold 50 collisions" >&2
    exit 1
  }
done
echo "the changes of docs/extending.md apply and work"
