#!/usr/bin/env bash
# Makes the npm package and the page of the mill, by Emscripten.
# File names in messages are those of the tree, so that the bytes do not depend on where it is.
# usage: npm.sh FOLDER    makes FOLDER/edmill-VERSION.tgz and FOLDER/edmill.html
set -euo pipefail
source_folder=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mkdir -p "$1" && cd "$1" && pwd)
toolchain=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake
export NODE_PATH=${NODE_PATH:-/usr/share/nodejs}
cmake -S "$source_folder" -B "$folder/build" -G Ninja -DEDMILL_CORE_ALONE=ON -DCMAKE_BUILD_TYPE=None \
  -DCMAKE_CXX_FLAGS="-DNDEBUG -O2 -ffile-prefix-map=$folder/build/headers/= -ffile-prefix-map=$source_folder/=" \
  -DCMAKE_TOOLCHAIN_FILE=$toolchain >/dev/null
# Clang orders some blocks of a function by their addresses: without their randomisation it makes
# the same bytes each time.
fixed=()
if setarch -R true 2>/dev/null; then fixed=(setarch -R); fi
"${fixed[@]}" cmake --build "$folder/build" --target npm page >/dev/null
cp "$folder"/build/npm/edmill-*.tgz "$folder/build/edmill.html" "$folder"
ls "$folder"/*.tgz "$folder/edmill.html"
