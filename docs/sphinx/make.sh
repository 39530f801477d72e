#!/usr/bin/env bash
# Makes the manual; warnings are errors.
# usage: make.sh FOLDER
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
folder=$(realpath -m "$1")
missing=()
need() { # package command...
  "${@:2}" >/dev/null 2>&1 || missing+=("$1")
}
need doxygen doxygen --version
need python3-sphinx sphinx-build --version
python=$(head -1 "$(command -v sphinx-build)" 2>/dev/null | sed -n 's/^#! *\(.*python[0-9.]*\).*/\1/p' || true)
for package in python3-myst-parser:myst_parser python3-breathe:breathe furo:furo; do
  need "${package%:*}" ${python:-python3} -c "import ${package#*:}"
done
if [ ${#missing[@]} -gt 0 ]; then
  echo "The manual needs ${missing[*]}: apt-get install ${missing[*]}" >&2
  exit 1
fi
rm -rf "$folder"
mkdir -p "$folder/doxygen"
(
  cd "$root"
  cat docs/sphinx/Doxyfile
  printf 'INPUT = %s/include/edmill\nSTRIP_FROM_INC_PATH = %s/include\nOUTPUT_DIRECTORY = %s/doxygen\n' "$root" "$root" "$folder"
) | doxygen - 2>"$folder/doxygen.log"
if [ -s "$folder/doxygen.log" ]; then
  cat "$folder/doxygen.log" >&2
  exit 1
fi
EDMILL_DOXYGEN_XML=$folder/doxygen/xml \
  sphinx-build -q -W --keep-going -d "$folder/doctrees" -c "$root/docs/sphinx" "$root/docs" "$folder/html"
# The mill in a browser, where it has been built (docs/portability.md).
[ ! -f "$root/build/page/edmill.html" ] || cp "$root/build/page/edmill.html" "$folder/html/mill.html"
echo "the manual is $folder/html/index.html"
