#!/usr/bin/env bash
# Sets edmill up on Debian 12 and 13 and on Ubuntu 24.04, and runs it. Every command can be
# repeated.
#
#   ./bootstrap.sh demo    install what is missing, build, run the demo case
#   ./bootstrap.sh test    install what is missing, build with tests, run all but the long studies
#   ./bootstrap.sh test fast  the same, but of the tests those that together take a minute
#   ./bootstrap.sh verify  the same set-up, LAMMPS, LIGGGHTS and YADE, then the long studies
#   ./bootstrap.sh analyse the same set-up, then clang-tidy, and the tests with the checks of the
#                          standard library
#   ./bootstrap.sh build   install what is missing, build the program: build/release/edmill
#   ./bootstrap.sh install release  install what release/make.sh needs
set -euo pipefail
cd "$(dirname "$0")"

# "a|b": the first of these that the release has. "a?": left out where the release has none; tests
# that need it are skipped.
program_packages=(
  g++ cmake ninja-build git ca-certificates
  "libboost1.81-dev|libboost-dev" libeigen3-dev libfmt-dev libcli11-dev libtomlplusplus-dev
  libmpfr-dev libgmp-dev "libflint-arb-dev|libflint-dev" libtbb-dev libhdf5-dev libpugixml-dev zlib1g-dev libzstd-dev libopenmpi-dev openmpi-bin
  nlohmann-json3-dev
)

test_packages=(
  libgtest-dev librapidcheck-dev libudunits2-dev libglpk-dev libgsl-dev zstd
  libbenchmark-dev clang "libclang-rt-14-dev|libclang-rt-19-dev|libclang-rt-18-dev" clang-format patch valgrind dpkg-dev file
  python3 python3-dev python3-numpy python3-pytest pybind11-dev python3-h5py python3-vtk9 view3dscene libxml2-utils
  "chromium?" "chromium-driver?" python3-selenium g++-s390x-linux-gnu qemu-user
  doxygen python3-sphinx python3-myst-parser python3-breathe furo python3-nbclient python3-ipykernel python3-matplotlib python3-pandas python3-xarray
)

long_packages=(lammps python3-lammps liggghts "yade?" debootstrap python3-venv python3-pip patchelf
  g++-aarch64-linux-gnu g++-riscv64-linux-gnu emscripten nodejs node-acorn debhelper dh-python lintian)

say() { printf '\n== %s\n' "$*"; }

is_installed() { dpkg-query -W -f='${db:Status-Status}\n' "$1" 2>/dev/null | grep -qx installed; }

# Whether the release has it; of clang's run-time libraries those of the clang that it installs.
has() {
  [[ $(LC_ALL=C apt-cache policy "$1" 2>/dev/null) =~ Candidate:\ [0-9] ]] || return 1
  [[ $1 =~ ^libclang-rt-([0-9]+)-dev$ ]] || return 0
  # No pipe into grep -q: it ends at the first match, and what it is fed by may then fail.
  [[ $(LC_ALL=C apt-cache depends clang 2>/dev/null)$'\n' == *" clang-${BASH_REMATCH[1]}"$'\n'* ]]
}

# Of alternatives that are all missing: the first that the release has; else the first, or nothing
# for "a?".
available() {
  local names one
  IFS='|' read -ra names <<<"${1%\?}"
  for one in "${names[@]}"; do
    if has "$one"; then
      echo "$one"
      return
    fi
  done
  [[ $1 == *\? ]] || echo "${names[0]}"
}

install_missing() {
  local missing=() package one alternatives
  for package in "$@"; do
    alternatives=${package%\?}
    for one in ${alternatives//|/ }; do
      is_installed "$one" && continue 2
    done
    missing+=("$package")
  done
  local needed=
  for package in "${missing[@]}"; do
    if [[ $package != *\? ]] || [ -n "$(available "$package")" ]; then needed=1; fi
  done
  if [ -z "$needed" ]; then
    say "all packages are installed"
    return
  fi
  local root=() chosen=()
  [ "$(id -u)" = 0 ] || root=(sudo)
  "${root[@]}" apt-get update -qq
  for package in "${missing[@]}"; do
    one=$(available "$package")
    if [ -n "$one" ]; then chosen+=("$one"); else say "this release has no ${package%\?}: what needs it is left out"; fi
  done
  [ ${#chosen[@]} != 0 ] || return 0
  say "installing ${chosen[*]}"
  "${root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${chosen[@]}"
}

build() { # preset target...    beside all that a fast build makes
  say "configuring and building (preset $1); the first time takes 3 to 15 minutes on two cores"
  cmake --preset "$1" >/dev/null
  # Ninja alone takes two more jobs than there are cores.
  cmake --build --preset "$1" --parallel "$(nproc)" --target all "${@:2}"
}

case "${1:-}" in
  build | demo)
    install_missing "${program_packages[@]}"
    build release
    if [ "$1" = demo ]; then
      say "running docs/examples/demo.toml: 28 balls, 10 s simulated"
      build/release/edmill run docs/examples/demo.toml
    fi
    ;;
  test)
    install_missing "${program_packages[@]}" "${test_packages[@]}"
    build ci
    say "running the tests"
    ctest --preset "${2:-ci}"
    ;;
  verify)
    install_missing "${program_packages[@]}" "${test_packages[@]}" "${long_packages[@]}"
    build ci check_certificate_without_arb
    say "running the long studies"
    ctest --preset verify
    ;;
  install)
    [ "${2:-}" = release ] || {
      echo "usage: ./bootstrap.sh install release" >&2
      exit 2
    }
    install_missing "${program_packages[@]}" "${test_packages[@]}" "${long_packages[@]}"
    ;;
  analyse)
    install_missing "${program_packages[@]}" "${test_packages[@]}" clang-tidy
    say "clang-tidy; .clang-tidy says what it looks for"
    cmake --preset analyse >/dev/null
    run-clang-tidy -quiet -j 2 -p build/analyse 'src/(core|files|case|run|pages|judge|proof|program)/' 2>/dev/null |
      { ! grep -E 'error:|warning:'; }
    build debug
    say "running the tests"
    ctest --preset debug
    ;;
  *)
    sed -n '2,10s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
