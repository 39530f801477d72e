#!/usr/bin/env bash
# Sweeps: the same tables from any number of threads and ranks, finished runs are kept after a kill,
# a failing point does not stop the others, and bad sweep files are explained.
# usage: sweep_test.sh EDMILL
set -euo pipefail
edmill=$1
source=$(cd "$(dirname "$0")/../../.." && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
failures=0
check() { # description command...
  local what=$1
  shift
  if "$@" >>log 2>&1; then echo "ok: $what"; else
    echo "FAILED: $what"
    failures=$((failures + 1))
  fi
}
same() { cmp "$1/sweep.csv" "$2/sweep.csv" && cmp "$1/runs.csv" "$2/runs.csv" && cmp "$1/sweep.h5" "$2/sweep.h5"; }

cat >small.toml <<EOF
[sweep]
case = "$source/docs/examples/demo.toml"
replicas = 3
[sweep.grid]
"run.end_time" = ["0.8 s"]
"contact.restitution" = [0.5, 0.6]
"balls.0.count" = [14, 28]
EOF
"$edmill" sweep small.toml --jobs 1 --out one --quiet
"$edmill" sweep small.toml --jobs 2 --out two --quiet
check "two threads give the tables of one" same one two
check "four points and their header" test "$(wc -l <one/sweep.csv)" = 5
check "twelve runs and their header" test "$(wc -l <one/runs.csv)" = 13

if "$edmill" --version >/dev/null && command -v mpirun >/dev/null; then
  mpirun --allow-run-as-root --oversubscribe -n 2 "$edmill" sweep small.toml --out ranks --quiet
  check "two ranks give the tables of one process" same one ranks
else
  echo "skipped: mpirun is not installed"
fi

# Mean and half-width of the first point, recomputed: three runs of 12 degrees of freedom and their
# scatter, pooled; Student's t of 12 and of 38.
check "the confidence interval pools the runs' own and their scatter" python3 - <<'EOF'
import csv, math, statistics
runs = [r for r in csv.DictReader(open("one/runs.csv")) if r["point"] == "1"]
values = [float(r["milling_dose_rate [W]"]) for r in runs]
own = [float(r["milling_dose_rate_ci95 [W]"]) / 2.178812829667228 for r in runs]
row = next(csv.DictReader(open("one/sweep.csv")))
assert len(values) == 3
mean, within = statistics.mean(values), sum(s * s for s in own) / 3
half = 2.024394164575136 * math.sqrt((2 * statistics.variance(values) + 36 * within) / 38 / 3)
assert math.isclose(mean, float(row["milling_dose_rate [W]"]), rel_tol=1e-12)
assert math.isclose(half, float(row["milling_dose_rate_ci95 [W]"]), rel_tol=1e-9)
EOF

# Killed midway: finished runs are not run again, and the tables are those of an undisturbed sweep.
sed 's/0.8 s/6 s/' small.toml >long.toml
"$edmill" sweep long.toml --jobs 1 --out killed --quiet &
pid=$!
for _ in $(seq 200); do
  [ "$(ls killed/runs 2>/dev/null | grep -c 'json$')" -ge 3 ] && break
  sleep 0.02
done
kill -KILL $pid 2>/dev/null || true
wait $pid 2>/dev/null || true
kept=$(ls killed/runs | grep -c 'json$')
check "the kill came midway ($kept of 12 runs)" test "$kept" -ge 3 -a "$kept" -lt 12
"$edmill" sweep long.toml --jobs 2 --out killed >report 2>&1
check "finished runs are reused" grep -q "^12 runs: $kept reused, $((12 - kept)) run now, 0 failed" report
"$edmill" sweep long.toml --jobs 2 --out whole --quiet
check "the resumed sweep has the tables of a whole one" same killed whole

# A point that cannot be filled fails alone.
sed 's/\[14, 28\]/[14, 4000]/' small.toml >failing.toml
code=0
"$edmill" sweep failing.toml --out failing --quiet || code=$?
check "a failing point gives exit code 5" test $code = 5
check "the other points finished" test "$(grep -c ',3,3,0,' failing/sweep.csv)" = 2

# Bad files: exit code 2, one message each, nothing written.
bad() { # expected-words, toml
  printf '%b' "$2" >bad.toml
  local code=0
  "$edmill" sweep bad.toml --out nowhere >out 2>err || code=$?
  check "explained: $1" test $code = 2 -a "$(wc -l <err)" = 1 -a ! -e nowhere
  check "  in words: $1" grep -q -- "$1" err
}
# A run that stalls and one that takes too long are told, and the others go on.
cat >piston.toml <<EOF
[run]
end_time = "0.9 s"
[mill]
type = "vibratory"
amplitude = [0, 0, 0]
speed = "900 rpm"
[vessel]
type = "box"
size = ["12 mm", "40 mm", "12 mm"]
[[vessel.piston]]
wall = "wall_2"
distance = "0 mm"
speed = "30 mm/s"
[contact]
restitution = 0.5
friction = 0.3
[[ball]]
diameter = "10 mm"
position = [0, 0.01, 0]
[[ball]]
diameter = "10 mm"
position = [0, -0.005, 0]
EOF
printf '[sweep]\ncase = "piston.toml"\n[sweep.grid]\n"run.end_time" = ["0.5 s", "0.9 s"]\n' >stalls.toml
"$edmill" sweep stalls.toml --out stalls --quiet && code=0 || code=$?
check "a stalled run is a failed one" test $code = 5
check "... with its status" grep -q ",stalled," stalls/runs.csv
check "... and the other is done" grep -q ",done," stalls/runs.csv
printf '[sweep]\ncase = "%s/docs/examples/demo.toml"\nmax_cpu_time = "0.2 s"\n[sweep.grid]\n"run.end_time" = ["0.51 s", "1000 s"]\n' \
  "$source" >limited.toml
"$edmill" sweep limited.toml --out limited --quiet && code=0 || code=$?
check "a run beyond max_cpu_time is a failed one" test $code = 5
check "... with its status" grep -q ",max_cpu_time," limited/runs.csv
check "... and the other is done" grep -q ",done," limited/runs.csv

demo="case = \"$source/docs/examples/demo.toml\""
bad "missing.toml" '[sweep]\ncase = "missing.toml"\nreplicas = 2\n'
bad "sweep.case" '[sweep]\nreplicas = 2\n'
bad "sweep.replicas" "[sweep]\n$demo\nreplicas = 0\n"
bad "sweep.replicas" "[sweep]\n$demo\nreplicas = \"many\"\n"
bad "sweep.max_cpu_time" "[sweep]\n$demo\nmax_cpu_time = \"0 s\"\n"
bad "sweep.repetitions" "[sweep]\n$demo\nrepetitions = 2\n"
bad "precision" "[sweep]\n$demo\nprecision = \"half\"\n"
bad "sweep.grid" "[sweep]\n$demo\ngrid = 3\n"
bad "contact.restitution" "[sweep]\n$demo\n[sweep.grid]\n\"contact.restitution\" = []\n"
bad "contact.bounce" "[sweep]\n$demo\n[sweep.grid]\n\"contact.bounce\" = [0.5]\n"
bad "TOML" '[sweep\n'

[ $failures = 0 ] || {
  cat log
  exit 1
}
echo "every check passed"
