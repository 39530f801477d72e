#!/usr/bin/env bash
# docs/sphinx/make.sh names each program and package that is missing, with the command that installs
# it, and touches no folder.
# usage: missing_test.sh FOLDER
set -euo pipefail
make=$(cd "$(dirname "$0")/../.." && pwd)/docs/sphinx/make.sh
rm -rf "$1"
mkdir -p "$1/bin" "$1/manual"
cd "$1"
touch manual/kept
for program in bash env cat sed head dirname realpath rm mkdir; do ln -s "$(command -v $program)" bin/; done
ask() { # what is expected
  if PATH=$PWD/bin "$make" manual >out 2>&1 || ! grep -qF "apt-get install $1" out || [ ! -f manual/kept ]; then
    echo "FAILED: expected 'apt-get install $1':"
    cat out
    exit 1
  fi
}
ask "doxygen python3-sphinx python3-myst-parser python3-breathe furo"
printf '#!/bin/sh\n' >bin/doxygen
chmod +x bin/doxygen
ask "python3-sphinx python3-myst-parser python3-breathe furo"
printf '#!%s/bin/python3 -s\n' "$PWD" >bin/sphinx-build # its packages are those of its own Python
printf '#!/bin/sh\ncase "$*" in *breathe*) exit 1 ;; esac\n' >bin/python3
chmod +x bin/sphinx-build bin/python3
ask "python3-breathe"
echo "what is missing is named, with the command that installs it"
