#!/usr/bin/env bash
# Runs in double and in float128 give the same bits from the program, and from the core alone as
# other compilers, optimisations and processors make it: regression/reference/bits.tsv. Foreign
# programs run under qemu-user, WebAssembly in node; what is not installed is told and left out.
# Runs also move from each of them to the program and back (moved_run.sh).
# usage: same_bits_test.sh PROGRAM FOLDER [--every N] MACHINE...    N: one log in N from the core
#     alone
set -euo pipefail
cd "$(dirname "$0")/../.."
program=$1
builds=$2
shift 2
every=1
[ "$1" != --every ] || { every=$2 && shift 2; }
# Foreign programs that need no libraries of their machine.
foreign=(-DCMAKE_SYSTEM_NAME=Linux -DCMAKE_EXE_LINKER_FLAGS=-static -DCMAKE_FIND_ROOT_PATH_MODE_PROGRAM=NEVER)

describe() { # machine: compiler, flags, options, runner, suffix
  options=() runner=() suffix=
  case $1 in
    g++-O0) compiler=g++ flags=-O0 ;;
    g++-native) compiler=g++ flags="-O3 -march=native" ;;
    clang++) compiler=clang++ flags=-O2 ;;
    aarch64 | riscv64 | s390x)
      compiler=$1-linux-gnu-g++ flags=-O1
      options=("${foreign[@]}" "-DCMAKE_SYSTEM_PROCESSOR=$1" "-DCMAKE_C_COMPILER=$1-linux-gnu-gcc")
      runner=("qemu-$1")
      ;;
    wasm32)
      compiler=em++ flags=-O2 suffix=.js
      options=(-DCMAKE_TOOLCHAIN_FILE=/usr/share/emscripten/cmake/Modules/Platform/Emscripten.cmake)
      runner=(node --no-experimental-fetch)
      # Debian keeps acorn, which the linker needs, where node looks itself and Emscripten's node
      # does not.
      export NODE_PATH=/usr/share/nodejs
      ;;
    *) echo "found machine '$1', expected g++-O0, g++-native, clang++, aarch64, riscv64, s390x or wasm32" >&2 && exit 2 ;;
  esac
}

tests/architecture/published_bits.sh "$builds/program" "$program"
different=0
for machine in "$@"; do
  describe "$machine"
  for tool in "$compiler" ${runner[0]:-}; do
    command -v "$tool" >/dev/null || { echo "$machine: $tool is not installed" && continue 2; }
  done
  cmake -S . -B "$builds/$machine" -G Ninja -DEDMILL_CORE_ALONE=ON -DEDMILL_WERROR=ON -DCMAKE_BUILD_TYPE=None "-DCMAKE_CXX_COMPILER=$compiler" \
    "-DCMAKE_CXX_FLAGS=-DNDEBUG $flags" "${options[@]}" >"$builds/$machine.log" 2>&1 &&
    cmake --build "$builds/$machine" --parallel 2 --target edmill_core_alone >>"$builds/$machine.log" 2>&1 || {
    grep -E "error|FAILED" "$builds/$machine.log" | head -20
    echo "$machine: the core does not compile"
    different=1
    continue
  }
  tests/architecture/published_bits.sh --every "$every" "$builds/$machine" "${runner[@]}" "$builds/$machine/edmill-core$suffix" || different=1
  tests/architecture/moved_run.sh "$builds/$machine/moved" "$program" "${runner[@]}" "$builds/$machine/edmill-core$suffix" || different=1
done
exit $different
