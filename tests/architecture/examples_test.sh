#!/usr/bin/env bash
# The programs of docs/examples build against the installed package and run; so does one when the
# package has been moved, found by CMake from a project in C++ alone and by pkg-config, for any
# folder of libraries.
# usage: examples_test.sh BUILD FOLDER COMPILER
set -euo pipefail
cd "$(dirname "$0")/../.."
build=$1
folder=$2
compiler=$3
rm -rf "$folder"
cmake --install "$build" --prefix "$folder/installed" >"$folder.log"
[ "$(find "$folder/installed/include" -name '*.hpp' | wc -l)" = "$(find include -name '*.hpp' | wc -l)" ]
"$folder/installed/bin/edmill" --version >/dev/null

cmake -S docs/examples -B "$folder/build" -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$folder/installed" \
  -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" >>"$folder.log"
cmake --build "$folder/build" >>"$folder.log" || {
  tail -n 30 "$folder.log" >&2
  exit 1
}

expect() { # words, then a command
  local words=$1 output
  shift
  output=$("$@")
  echo "$output"
  grep -qE "$words" <<<"$output" || {
    echo "$1: expected '$words'" >&2
    exit 1
  }
}
demo=docs/examples/demo.toml
# The dose that the program itself gives for these two seconds.
"$folder/installed/bin/edmill" run $demo --quiet --out "$folder/run" --set 'run.end_time="2 s"'
dose=$(python3 -c "import json; print('%.6g' % json.load(open('$folder/run/summary.json'))['milling_dose'])")
expect "^milling dose ${dose//./\\.} J in 2 s$" "$folder/build/own_observer" $demo
expect "^viscoelastic: [0-9.]+ W$" "$folder/build/own_contact_law" $demo
expect "^stopped at [0-9.]+ s$" "$folder/build/own_stop_rule" $demo
expect "^hexagonal jar: [0-9.]+ W, 9 kinds of partners$" "$folder/build/own_vessel" $demo
expect "^conical jar: [0-9.]+ W, 4 kinds of partners$" "$folder/build/own_mill" $demo
expect "^e 0.9: [0-9.]+ W$" "$folder/build/own_study" $demo
# From an empty folder, into a folder of it.
root=$PWD
mkdir "$folder/empty"
cd "$folder/empty"
expect "^until 3 s with e 0.3[0-9]+: [0-9.]+ J$" "$folder/build/own_coupling" "$root/$demo" coupling
[ -f coupling/3/summary.json ]
cd "$root"
for example in own_observer own_contact_law own_stop_rule own_vessel own_mill own_study own_coupling; do
  code=0
  "$folder/build/$example" no_such_case.toml $([ $example != own_coupling ] || echo "$folder/coupling") 2>/dev/null || code=$?
  [ $code = 2 ] || {
    echo "$example: exit code $code for a file that is not there, expected 2" >&2
    exit 1
  }
  [ "$(wc -l <docs/examples/$example.cpp)" -lt 60 ]
done

mv "$folder/installed" "$folder/moved"
cd "$folder/empty"
cp "$root/docs/examples/own_observer.cpp" .
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(mine CXX)
find_package(edmill 1.0 REQUIRED)
add_executable(by_cmake own_observer.cpp)
target_link_libraries(by_cmake PRIVATE edmill::edmill)
END
cmake -S . -B build -G Ninja -DCMAKE_CXX_COMPILER="$compiler" -DCMAKE_PREFIX_PATH="$folder/moved" >>"$folder.log"
cmake --build build >>"$folder.log"
found=$(dirname "$(find "$folder/moved" -name edmill.pc)")
read -ra flags <<<"$(PKG_CONFIG_PATH=$found pkg-config --cflags --libs edmill)"
"$compiler" own_observer.cpp "${flags[@]}" -o by_pkg_config
for program in build/by_cmake ./by_pkg_config; do
  expect "^milling dose ${dose//./\\.} J in 2 s$" $program "$root/$demo"
done

# Where each layout's pkg-config file finds the rest.
for libraries in lib lib64 lib/x86_64-linux-gnu /opt/libraries; do
  place=$folder/layout/${libraries#/}
  cmake -DCMAKE_INSTALL_PREFIX="$folder/layout" -DCMAKE_INSTALL_INCLUDEDIR=include -DCMAKE_INSTALL_LIBDIR=$libraries \
    -DPROJECT_VERSION=1 -DPROJECT_DESCRIPTION=edmill -DEDMILL_PC="$place/pkgconfig/edmill.pc" -P "$root/cmake/PkgConfig.cmake"
  variable() { realpath -m "$(PKG_CONFIG_PATH=$place/pkgconfig pkg-config --variable="$1" edmill)"; }
  [ "$(variable includedir)" = "$(realpath "$folder")/layout/include" ]
  [ "$(variable libdir)" = "$(cd "$folder/layout" && realpath -m "$libraries")" ]
done
echo "the examples build against the installed package and run, and the package can be moved"
