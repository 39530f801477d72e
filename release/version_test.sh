#!/usr/bin/env bash
# Whether all files that name the version name the same, and every address is that of CITATION.cff.
set -euo pipefail
cd "$(dirname "$0")/.."
version=$(sed -n 's/^project(edmill VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
found() { # file, expression of sed that prints its version
  local one
  one=$(sed -n "$2" "$1" | head -n 1)
  [ "$one" = "$version" ] || {
    echo "$1: version '$one', expected $version as in CMakeLists.txt"
    exit 1
  }
}
found pyproject.toml 's/^version = "\(.*\)"/\1/p'
found CITATION.cff 's/^version: \(.*\)/\1/p'
found codemeta.json 's/.*"version": "\(.*\)".*/\1/p'
found debian/changelog 's/^edmill (\([0-9.]*\)-.*/\1/p'
home=$(sed -n 's/^url: //p' CITATION.cff)
for file in codemeta.json pyproject.toml debian/control src/bindings/node/package.json release/suite.md; do
  grep -qF "$home" "$file" || {
    echo "$file: no address $home, expected that of CITATION.cff: release/addresses.sh"
    exit 1
  }
done
echo "version $version, $home"
