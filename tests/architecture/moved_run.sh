#!/usr/bin/env bash
# A run that is killed on one machine goes on on the other from its checkpoint, with the bits of a
# run that was not.
# usage: moved_run.sh FOLDER PROGRAM COMMAND...
# PROGRAM is edmill; COMMAND is edmill-core after what runs it: qemu-s390x edmill-core. Each begins
# what the other ends.
set -euo pipefail
mkdir -p "$1"
folder=$(realpath "$1")
program=$(realpath "$2")
core=("${@:3:$#-3}" "$(realpath "${@: -1}")")
cd "$(dirname "$0")/../.."
settings=("run.start_time=0 s" 'output=[{type="collisions"}]')
every="0.001 s simulated"

killed_after_a_checkpoint() { # folder command...
  "${@:2}" >"$folder/said" 2>&1 &
  local run=$!
  until [ -e "$1/checkpoint" ]; do
    kill -0 $run 2>/dev/null || { cat "$folder/said" && echo "the run ended without a checkpoint" && exit 1; }
    sleep 0.005
  done
  kill -KILL $run
  wait $run 2>/dev/null || true
  [ -e "$1/checkpoint" ] || { echo "the run ended before it was killed" && exit 1; }
}

for row in "double 20000" "float128 2000"; do
  read -r precision impacts <<<"$row"
  given=("${settings[@]}" "run.max_collisions=$impacts")
  options=()
  for setting in "${given[@]}"; do options+=(--set "$setting"); done
  published=$(awk -F'\t' -v p="$precision" '$1 == "demo" && $3 == p { print $5 }' regression/reference/bits.tsv)
  for from in core program; do
    run=$folder/$from-$precision
    rm -rf "$run"
    if [ $from = core ]; then
      killed_after_a_checkpoint "$run" "${core[@]}" --checkpoint "$every" docs/examples/demo.toml "$run" "$precision" "${given[@]}"
      "$program" resume --quiet "$run" >"$folder/said" 2>&1 || { cat "$folder/said" && exit 1; }
    else
      killed_after_a_checkpoint "$run" "$program" run docs/examples/demo.toml --quiet --out "$run" --checkpoint "$every" \
        --precision "$precision" "${options[@]}"
      "${core[@]}" resume "$run" >"$folder/said" 2>&1 || { cat "$folder/said" && exit 1; }
    fi
    digest=$(sha256sum <"$run/collisions.csv" | cut -d' ' -f1)
    [ "$digest" = "$published" ] || { echo "$from-$precision: found $digest, expected $published" && exit 1; }
  done
done
echo "${core[*]}: runs that moved from it and to it have the published bits"
