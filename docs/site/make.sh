#!/usr/bin/env bash
# One folder for any web server: a start page, the manual, the pages of docs/samples, and the mill
# in a browser where it has been built (docs/portability.md).
# usage: make.sh FOLDER [MANUAL]    MANUAL: what docs/sphinx/make.sh has made, else it is made
set -euo pipefail
docs=$(cd "$(dirname "$0")/.." && pwd)
folder=$(realpath -m "$1")
manual=$(realpath -m "${2:-$folder.manual}")
[ -n "${2:-}" ] || "$docs/sphinx/make.sh" "$manual" >/dev/null
if [ -e "$folder" ] && [ -n "$(ls -A "$folder")" ] && [ ! -f "$folder/samples/report.html" ]; then
  echo "$folder has other files: give a folder that is empty, or one that this script has made" >&2
  exit 1
fi
rm -rf "$folder"
mkdir -p "$folder/samples"
cp -r "$manual/html" "$folder/manual"
cp "$docs"/samples/*.html "$folder/samples"
cp "$docs/site/index.html" "$folder"
mill=$docs/../build/page/edmill.html
if [ -f "$mill" ]; then cp "$mill" "$folder/mill.html"; else sed -i '/<li id="mill">/d' "$folder/index.html"; fi
[ -n "${2:-}" ] || rm -rf "$manual"
echo "the start page is $folder/index.html"
