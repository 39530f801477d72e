#!/usr/bin/env bash
# Writes the address of the project into all files that name it, in place of the placeholder or of
# the address before.
# usage: addresses.sh HOME [REPOSITORY]    e.g. addresses.sh https://edmill.example
#     https://edmill.example/edmill.git
set -euo pipefail
cd "$(dirname "$0")/.."
new=${1:?usage: addresses.sh HOME [REPOSITORY]}
[[ $new =~ ^https://[A-Za-z0-9./_-]+$ ]] || {
  echo "found '$new', expected an address that begins with https://" >&2
  exit 2
}
new=${new%/}
repository=${2:-$new/edmill.git}
old=$(sed -n 's/^url: //p' CITATION.cff) old_repository=$(sed -n 's/^repository-code: //p' CITATION.cff)
quoted() { printf '%s' "$1" | sed 's/[.[\*^$/&|]/\\&/g'; }
files=$(git grep -lF "$old" -- ':!release/addresses.sh')
for file in $files; do
  sed -i "s|$(quoted "$old_repository")|$(quoted "$repository")|g; s|$(quoted "$old")|$(quoted "$new")|g" "$file"
done
echo "$files"
