#!/usr/bin/env bash
# The suite of reference cases: its closed forms can be made again, edmill agrees with the events
# and the statistics of every case, and the comparison programs accept what is right and reject what
# is changed.
# usage: suite_test.sh EDMILL PYTHON FOLDER
set -euo pipefail
export PYTHONDONTWRITEBYTECODE=1
edmill=$1
python=$2
folder=$3
suite=$(cd "$(dirname "$0")/../../../regression/reference/suite" && pwd)
rm -rf "$folder"
mkdir -p "$folder"
cd "$folder"
fail() {
  echo "$1" >&2
  exit 1
}

"$python" "$suite/closed_forms.py" made
for file in made/*/*; do diff "$suite/${file#made/}" "$file" || fail "$file is not what closed_forms.py makes"; done
for program in compare compare_statistics; do c++ -std=c++17 -Wall -Wextra -Werror -O1 "$suite/$program.cpp" -o $program; done
for program in compare.cpp compare_statistics.cpp; do
  [ "$(wc -l <"$suite/$program")" -le 75 ] || fail "$program has more than 75 lines"
done

expect() { # exit code, message, then a command
  local code=0
  "${@:3}" >printed 2>errors || code=$?
  [ $code = "$1" ] || {
    cat printed errors >&2
    fail "$2: exit code $code, expected $1"
  }
}
field() { "$python" -c "import json, sys; print(json.load(open(sys.argv[1])).get(sys.argv[2], ''))" "$suite/$1/suite.json" "$2"; }

in_python() { # name of the case, file
  "$python" "$suite/check.py" "$suite/$1" "$2"
}

# A run of edmill, then logs with one event left out, two swapped, a time off by a thousandth,
# another partner.
events_agree() { # name, events, settings
  local name=$1 events=$suite/$1/$2 log=$1/collisions.csv count tolerance
  count=$(field "$name" agree) tolerance=$(field "$name" tolerance)
  "$edmill" run "$suite/$name/$(field "$name" case)" --quiet --out "$name" \
    --set 'output=[{type="collisions", states=true}]' --set run.max_collisions=$((count + 5)) "${@:3}"
  expect 0 "check.py: edmill differs in $name" in_python "$name" "$log"
  cat printed
  expect 0 "compare.cpp: edmill differs in $name" ./compare "$events" "$log" "$count" "$tolerance"
  awk 'NR != 4' "$log" >left_out.csv
  awk 'NR == 3 {kept = $0; next} {print} NR == 4 {print kept}' "$log" >swapped.csv
  awk -F, -v OFS=, 'NR == 5 {$2 = sprintf("%.17g", $2 * (1 + 1e-3) + 1e-3)} {print}' "$log" >late.csv
  awk -F, -v OFS=, 'NR == 4 {$5 = $5 + 7} {print}' "$log" >partner.csv
  awk -F, -v OFS=, 'NR == 1 {for (k = 1; k <= NF; ++k) if ($k == "time") place = k} NR == 4 {$place = "?"} {print}' "$log" >no_number.csv
  for column in time ball partner_kind partner; do
    sed "1s/\(^\|,\)$column\(,\|\$\)/\1no_$column\2/" "$log" >no_column.csv
    expect 2 "check.py: a log of $name without $column" in_python "$name" no_column.csv
    expect 2 "compare.cpp: a log of $name without $column" ./compare "$events" no_column.csv "$count" "$tolerance"
  done
  expect 2 "check.py: a log of $name whose time is no number" in_python "$name" no_number.csv
  expect 1 "compare.cpp: a log of $name whose time is no number" ./compare "$events" no_number.csv "$count" "$tolerance"
  for changed in left_out swapped late partner; do
    expect 1 "check.py: a log of $name that is changed: $changed" in_python "$name" $changed.csv
    expect 1 "compare.cpp: a log of $name that is changed: $changed" ./compare "$events" $changed.csv "$count" "$tolerance"
    rejected=$((rejected + 2))
  done
}

# Short runs of edmill; then all values just within, and all just outside, tolerance and 3 standard
# uncertainties.
statistics_agree() { # name, statistics
  local name=$1 table=$suite/$1/$2 share code differ
  "$python" "$suite/edmill_statistics.py" "$edmill" "$name" found.csv --short
  expect 0 "check.py: edmill differs in $name" in_python "$name" found.csv
  tail -n 1 printed
  expect 0 "compare_statistics.cpp: edmill differs in $name" ./compare_statistics "$table" found.csv
  for share in -0.999 0.999 -1.001 1.001; do
    awk -F, -v share=$share '/^#/ {next} $1 == "name" {print "name,value"; next}
      {printf "%s,%.17g\n", $1, $3 + share * ($7 + 3 * $4)}' "$table" >edge.csv
    awk -F, 'NR > 1 {printf "%s\"%s\": %s", NR == 2 ? "{" : ", ", $1, $2} END {print "}"}' edge.csv >edge.json
    code=0 differ=0
    [ ${share#-} = 0.999 ] || code=1 differ=$(($(wc -l <edge.csv) - 1))
    expect $code "check.py: values of $name at the edge" in_python "$name" edge.json
    [ "$(grep -c ^DIFFERS printed)" = $differ ] || fail "check.py: values of $name at the edge"
    expect $code "compare_statistics.cpp: values of $name at the edge" ./compare_statistics "$table" edge.csv
    [ "$(grep -c ^DIFFERS printed)" = $differ ] || fail "compare_statistics.cpp: values of $name at the edge"
    rejected=$((rejected + 2 * code))
  done
}

cases=0 statistics=0 rejected=0
for about in "$suite"/*/suite.json; do
  name=$(basename "$(dirname "$about")")
  [ "$(field "$name" licence)" = CC0-1.0 ] || fail "$about names no licence"
  events=$(field "$name" events) table=$(field "$name" statistics)
  [ -n "$events$table" ] || fail "$about has nothing to compare"
  [ -z "$events" ] || events_agree "$name" "$events"
  [ -z "$table" ] || {
    statistics_agree "$name" "$table"
    statistics=$((statistics + 1))
  }
  cases=$((cases + 1))
done
[ $cases -ge 14 ] && [ $statistics -ge 6 ] || fail "found $cases cases, $statistics with statistics"
# A least separation speed makes the same hops at any restitution.
events_agree slipping_particle events.csv --set contact.restitution=0.5 --set 'contact.least_separation="9.8 mm/s"'
# The theory beside the statistics of the gas is that of closed_forms.py; what is exact is within 3
# standard uncertainties.
"$python" - "$suite" <<'END' || fail "elastic_gas: theory"
import csv, sys
sys.path.insert(0, sys.argv[1])
import gas_theory
theory = gas_theory.elastic_gas()
with open(sys.argv[1] + "/elastic_gas/statistics.csv") as file:
    rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
assert {row["name"] for row in rows} == theory.keys()
for row in rows:
    value, u, stated = (float(row[k]) for k in ("value", "standard_uncertainty", "theory"))
    exact, kind = theory[row["name"]]
    assert row["theory_is"] == kind and abs(stated / float(exact) - 1) < 1e-4, row
    assert abs(value - float(exact)) <= 3 * u + 1e-15 * value, row
END
printf 'name,value\nno_such_quantity,1\n' >unknown.csv
expect 2 "check.py: a log that does not exist" in_python spex_1 missing.csv
for file in missing.csv unknown.csv; do
  expect 2 "check.py: $file" in_python spex_3 $file
  expect 2 "compare_statistics.cpp: $file" ./compare_statistics "$suite/spex_3/statistics.csv" $file
done
# A folder of files, right ones and altered ones, with JUnit; a DEM case among them.
mkdir all
for name in bouncing_ball oblique_impact spex_3 stirred; do cp "$name/collisions.csv" all/$name.csv; done
cp found.csv all/stacked_particles.statistics.csv
printf 'name,value\nnormal_speed_after,0.4005\ntangential_speed_after,1.73\nspin_after,135\n' >all/mohajeri_oblique.csv
expect 0 "check.py: a folder" "$python" "$suite/check.py" all --junit all.xml
sed -i '3s/[0-9]\./9./' all/bouncing_ball.csv
sed -i 's/^spin_after.*/spin_after,138/' all/mohajeri_oblique.csv
expect 1 "check.py: a folder with two altered files" "$python" "$suite/check.py" all --junit altered.xml
[ "$(grep -c ^DIFFERS printed)" = 2 ] && grep -q '^DIFFERS bouncing_ball: event' printed && grep -q '^DIFFERS mohajeri_oblique: spin_after' printed ||
  fail "check.py: the altered files are not named"
"$python" - <<'END' || fail "check.py: JUnit"
import xml.etree.ElementTree as tree
for file, failures in (("all.xml", 0), ("altered.xml", 2)):
    suite = tree.parse(file).getroot()
    assert int(suite.get("failures")) == failures == len(suite.findall("testcase/failure")), file
    assert int(suite.get("tests")) == len(suite.findall("testcase")) > 7, file
END
expect 2 "check.py: an empty folder" "$python" "$suite/check.py" made/bouncing_ball
echo "$cases cases agree, $statistics of them in statistics; $rejected changed files are rejected"
