#!/usr/bin/env bash
# Makes the reference suite alone as an archive, with the same bytes each time from the same commit.
# usage: suite.sh FOLDER    makes FOLDER/edmill-suite-VERSION.tar.gz
set -euo pipefail
source_folder=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mkdir -p "$1" && cd "$1" && pwd)
version=$(sed -n 's/^project(edmill VERSION \([0-9.]*\).*/\1/p' "$source_folder/CMakeLists.txt")
name=edmill-suite-$version
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir "$work/$name"
cd "$source_folder/regression/reference"
git ls-files -z | grep -zv '^\(bits.tsv\|whole_demo.py\|README.md\|suite/README.md\|dem/make_cases.py\|suite/edmill_statistics.py\)$' |
  tar --null -T - -cf - | tar -C "$work/$name" -xf -
cp "$source_folder/docs/log-format.md" "$source_folder/docs/log-format.schema.json" "$work/$name"
sed "s/{{version}}/$version/g" "$source_folder/release/suite.md" >"$work/$name/README.md"
cp "$source_folder/release/CC0.txt" "$work/$name/LICENCE"
mv "$work/$name/suite/check.py" "$work/$name"
cd "$work/$name"
find . -type f ! -name SHA256SUMS -printf '%P\n' | LC_ALL=C sort | xargs sha256sum >SHA256SUMS
cd ..
date=$(git -C "$source_folder" log -1 --format=%ct)
LC_ALL=C tar --sort=name --mtime="@$date" --owner=0 --group=0 --numeric-owner --mode=u+rw,go+r,go-w -cf - "$name" | gzip -9n >"$folder/$name.tar.gz"
echo "$folder/$name.tar.gz"
