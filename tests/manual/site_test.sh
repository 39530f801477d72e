#!/usr/bin/env bash
# The pages of docs/samples are those that docs/samples/make.sh makes, of at most 600 kB each, and
# every link of the start page of docs/site leads somewhere.
# usage: site_test.sh EDMILL MANUAL FOLDER
set -euo pipefail
docs=$(cd "$(dirname "$0")/../../docs" && pwd)
edmill=$1
manual=$2
folder=$3
fail() {
  echo "$1" >&2
  exit 1
}
"$docs/samples/make.sh" "$edmill" "$folder/made"
for page in report comparison sweep; do
  cmp "$docs/samples/$page.html" "$folder/made/$page.html" || fail "docs/samples/make.sh EDMILL docs/samples makes it again"
  [ "$(wc -c <"$docs/samples/$page.html")" -le 600000 ] || fail "$page.html has more than 600 kB"
done
"$docs/site/make.sh" "$folder/site" "$manual"
links=$(grep -o 'href="[^"]*"' "$folder/site/index.html" | sed 's/href="\(.*\)"/\1/')
[ "$(wc -l <<<"$links")" -ge 7 ] || fail "found the links $links, expected seven or more"
for link in $links; do [ -f "$folder/site/$link" ] || fail "$link leads nowhere"; done
