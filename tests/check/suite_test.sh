#!/usr/bin/env bash
# The suite of reference cases: its closed forms can be made again, edmill agrees with every case, and both comparison programs
# accept what is right and reject what is changed.
# usage: suite_test.sh EDMILL PYTHON FOLDER
set -euo pipefail
edmill=$1
python=$2
folder=$3
suite=$(cd "$(dirname "$0")/../../regression/reference/suite" && pwd)
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
fail() {
  echo "$1" >&2
  exit 1
}

"$python" "$suite/closed_forms.py" made
for file in made/*/*; do diff "$suite/${file#made/}" "$file" || fail "$file is not what closed_forms.py makes"; done
c++ -std=c++17 -Wall -Wextra -Werror -O1 "$suite/compare.cpp" -o compare

field() { "$python" -c "import json, sys; print(json.load(open(sys.argv[1]))[sys.argv[2]])" "$suite/$1/suite.json" "$2"; }
cases=0
for about in "$suite"/*/suite.json; do
  name=$(basename "$(dirname "$about")")
  events=$suite/$name/$(field "$name" events) count=$(field "$name" agree) tolerance=$(field "$name" tolerance)
  "$edmill" run "$suite/$name/$(field "$name" case)" --quiet --out "$name" --set 'output=[{type="collisions", states=true}]' \
    --set run.max_collisions=$((count + 5))
  log=$name/collisions.csv
  "$python" "$suite/compare.py" "$suite/$name" "$log" || fail "edmill differs in $name"
  ./compare "$events" "$log" "$count" "$tolerance" >/dev/null || fail "compare.cpp: edmill differs in $name"

  # Changed logs: one event left out, two swapped, a time off by a millionth, another partner.
  awk 'NR != 4' "$log" >left_out.csv
  awk 'NR == 3 {kept = $0; next} {print} NR == 4 {print kept}' "$log" >swapped.csv
  awk -F, -v OFS=, 'NR == 5 {$2 = sprintf("%.17g", $2 * (1 + 1e-3) + 1e-3)} {print}' "$log" >late.csv
  awk -F, -v OFS=, 'NR == 4 {$5 = $5 + 7} {print}' "$log" >partner.csv
  for changed in left_out swapped late partner; do
    code=0
    "$python" "$suite/compare.py" "$suite/$name" $changed.csv >/dev/null || code=$?
    [ $code = 1 ] || fail "compare.py accepts a log of $name that is changed: $changed"
    code=0
    ./compare "$events" $changed.csv "$count" "$tolerance" >/dev/null || code=$?
    [ $code = 1 ] || fail "compare.cpp accepts a log of $name that is changed: $changed"
  done
  cases=$((cases + 1))
done
[ $cases -ge 6 ] || fail "found $cases cases"
code=0
"$python" "$suite/compare.py" "$suite/spex_1" missing.csv 2>/dev/null || code=$?
[ $code = 2 ] || fail "compare.py: exit code $code for a log that does not exist"
echo "$cases cases agree, and $((8 * cases)) changed logs are rejected"
