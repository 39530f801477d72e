#!/usr/bin/env bash
# The pages of this folder: the report of a run, a comparison of two, a sweep. They have neither
# commit nor times, so that they are the same wherever they are made.
# usage: make.sh EDMILL FOLDER
set -euo pipefail
edmill=$(realpath "$1")
folder=$(realpath -m "$2")
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"
for balls in steel tungsten-carbide; do
  "$edmill" new --mill 8000M --balls "10x10mm:$balls" --powder 4g --target-dose "10 kJ/g" --time "3 s" --out "$balls.toml"
  "$edmill" run "$balls.toml" --report --quiet --out "$balls"
done
"$edmill" report steel tungsten-carbide --out comparison.html >/dev/null
cat >speed.sweep.toml <<'END'
[sweep]
case = "steel.toml"
replicas = 3
[sweep.grid]
"mill.speed" = ["875 rpm", "920 rpm", "965 rpm", "1010 rpm", "1060 rpm"]
"balls.0.count" = [5, 10]
"run.end_time" = ["2 s"]
END
"$edmill" sweep speed.sweep.toml --quiet --out speed >/dev/null
mkdir -p "$folder"
for page in steel/report.html:report.html comparison.html:comparison.html speed/sweep.html:sweep.html; do
  sed -E -e 's/edmill ([0-9.]+) \([0-9a-z-]+\)(, [^<]*)?/edmill \1/g' -e 's|(CPU time</th><td>)[0-9.e-]+ s for |\1for |' \
    -e 's|<a href="(runs/[^"]*\|sweep\.csv\|runs\.csv)">([^<]*)</a>|\2|g' "${page%:*}" >"$folder/${page#*:}"
done
