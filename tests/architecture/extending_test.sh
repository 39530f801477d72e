#!/usr/bin/env bash
# The changes shown in docs/extending.md apply to the tree, and what they add works.
# usage: extending_test.sh FOLDER COMPILER BUILD PYTHON
#        extending_test.sh FOLDER    the changes apply; nothing is compiled
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=$1
compiler=${2:-}
build=${3:-}
fail() {
  echo "$*" >&2
  exit 1
}
rm -rf "$folder"
mkdir -p "$folder"
cp -r CMakeLists.txt README.md cmake src include docs tests verification regression "$folder"

# changes FILE [SECTION...]: the diffs of the page, or of these sections of it.
changes() {
  local sections=${*:2}
  awk -v only="${sections// /|}" '/^## /{here = only == "" || $0 ~ "^## A (" only ")$"} here || only == ""' docs/extending.md |
    sed -n '/^```diff$/,/^```$/{/^```/!p}' >"$1"
  grep -q '^+' "$1" || fail "docs/extending.md shows no change"
}
changes "$folder/change.diff"
(cd "$folder" && patch -p1 --forward --fuzz=0 <change.diff)
[ -n "$compiler" ] || exit 0

# A command and a Python function take the program's libraries as they are: only what these sections
# change is compiled.
tools=$folder/tools
mkdir "$tools"
cp -r src include "$tools"
changes "$tools/change.diff" command "Python.function"
(cd "$tools" && patch -p1 --forward --fuzz=0 <change.diff >/dev/null)
# command_of TARGET: how the build makes it, without headers that were parsed before.
command_of() {
  ninja -C "$build" -t commands "$1" | tail -1 | sed -e 's/ -Winvalid-pch -include [^ ]*//' -e 's/ -M[DTF] .*//'
}
# compiled SOURCE as OBJECT: in the way of an object of the build.
compiled() {
  local command
  command=$(command_of "$3")
  eval "${command//$PWD\/src/$tools/src} -O0 -c $tools/$1 -o $tools/$1.o"
}
build_tools() {
  local source=$PWD main=CMakeFiles/edmill_cli.dir/src/program/cli/main.cpp.o module=CMakeFiles/edmill_python.dir/Unity/unity_0_cxx.cxx.o
  local name
  name=$(basename "$build"/python/edmill/_edmill*.so)
  compiled src/program/cli/main.cpp as $main
  compiled src/bindings/python/count_in_python.cpp as $module
  cd "$build"
  eval "$(command_of edmill | sed -e "s|$main|$tools/src/program/cli/main.cpp.o|" -e "s|-o edmill |-o $tools/edmill |")"
  eval "$(command_of "python/edmill/$name" |
    sed -e "s|$module|& $tools/src/bindings/python/count_in_python.cpp.o|" -e "s|-o [^ ]*|-o $tools/src/bindings/python/edmill/$name|")"
  cd "$source"
}
build_tools >"$tools/log" 2>&1 &
tools_build=$!

# The core is enough: collision_bits prints the log of a run.
cmake -S "$folder" -B "$folder/build" -G Ninja -DCMAKE_BUILD_TYPE=None -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_CXX_FLAGS=-O0 \
  -DEDMILL_BENCHMARKS=OFF >"$folder/log" 2>&1 && cmake --build "$folder/build" --target collision_bits >>"$folder/log" 2>&1 || {
  fail "$(tail -n 30 "$folder/log")"
}
for model in power walton-braun; do
  log=$folder/$model.csv
  "$folder/build/tests/collision_bits" docs/examples/demo.toml 50 "contact.model=$model" >"$log"
  [ "$(wc -l <"$log")" = 51 ] || fail "model = \"$model\": the log does not hold 50 collisions"
done
if cmp -s "$folder/power.csv" "$folder/walton-braun.csv"; then fail "model = \"power\" gives the same run as walton-braun"; fi
refused() { # setting... of which the last is wrong
  local last=${!#}
  if "$folder/build/tests/collision_bits" docs/examples/demo.toml 50 "$@" >"$folder/refused.csv" 2>"$folder/error"; then fail "$* is accepted"; fi
  grep -q "key '${last%%=*}'" "$folder/error" || fail "$* is refused without naming the key"
}
refused contact.model=power contact.restitution=2
refused run.max_spin="0 rad/s"
refused run.title=5
refused 'vessel.piston=[{wall="cap -y",distance="1 mm"}]' vessel.piston.0.note.author=5
for parts in "vessel={type=\"edged_jar\",side=\"34 mm\",height=\"57 mm\"}" "mill={type=\"turntable\",speed=\"300 rpm\"}" \
  "output=[{type=\"hardest\"}]" "vessel.piston=[{wall=\"cap -y\",distance=\"1 mm\",note={author=\"me\"}}]" "run.title=\"28 balls\""; do
  "$folder/build/tests/collision_bits" docs/examples/demo.toml 50 "$parts" 'run.start_time="0 s"' >"$folder/parts.csv" 2>"$folder/parts.json"
  [ "$(wc -l <"$folder/parts.csv")" = 51 ] || fail "$parts: the log does not hold 50 collisions"
  grep -q '"fastest_spin": [1-9]' "$folder/parts.json" || fail "$parts: the summary has no number of the observer"
  grep -q '"mean_milling_dose": [0-9]' "$folder/parts.json" || fail "$parts: the summary has no new field"
done
"$folder/build/tests/collision_bits" docs/examples/demo.toml 5000 run.max_spin="200 rad/s" >"$folder/spin.csv" 2>"$folder/spin.json"
grep -q '"end_reason": "max_spin"' "$folder/spin.json" || fail "max_spin did not end the run"

wait $tools_build || fail "$(tail -n 30 "$tools/log")"
[ "$("$tools/edmill" count docs/examples/demo.toml)" = 28 ] || fail "edmill count"
[ "$(PYTHONPATH=$tools/src/bindings/python "$4" -c "import edmill; print(edmill.count('docs/examples/demo.toml'))")" = 28 ] || fail "edmill.count"
echo "the changes of docs/extending.md apply and work"
