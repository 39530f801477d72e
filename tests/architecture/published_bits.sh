#!/usr/bin/env bash
# A program's logs have the published digests: regression/reference/bits.tsv.
# usage: published_bits.sh [--write | --every N] FOLDER COMMAND...
# COMMAND is edmill, or edmill-core after what runs it: qemu-s390x edmill-core. --write publishes
# its digests, --every tries one log in N.
set -euo pipefail
write= every=1
case $1 in
  --write) write=1 && shift ;;
  --every) every=$2 && shift 2 ;;
esac
folder=$1
command=("${@:2}")
cd "$(dirname "$0")/../.."
published=regression/reference/bits.tsv
mkdir -p "$folder"

run() { # case precision setting...
  local out=$folder/out given=()
  rm -rf "$out"
  if [[ ${command[-1]} == */edmill ]]; then
    for setting in "${@:3}"; do given+=(--set "$setting"); done
    "${command[@]}" run "docs/examples/$1" --quiet --out "$out" --set "run.precision=$2" "${given[@]}"
  else
    "${command[@]}" "docs/examples/$1" "$out" "$2" "${@:3}"
  fi
}

different=0 place=0 tried=0
while IFS= read -r line; do
  if [[ $line == \#* ]]; then
    [ -z "$write" ] || echo "$line" >>"$folder/bits.tsv"
    continue
  fi
  (((place++) % every == 0)) || continue
  tried=$((tried + 1))
  IFS=$'\t' read -ra field <<<"$line"
  run "${field[1]}" "${field[2]}" "${field[@]:5}" >"$folder/said" || { cat "$folder/said" && exit 1; }
  digest=$(sha256sum <"$folder/out/${field[3]}" | cut -d' ' -f1)
  if [ -n "$write" ]; then
    field[4]=$digest
    (IFS=$'\t' && echo "${field[*]}") >>"$folder/bits.tsv"
  elif [ "$digest" != "${field[4]}" ]; then
    echo "${field[0]}, ${field[2]}: found $digest, expected ${field[4]}"
    different=1
  fi
done <$published
[ -z "$write" ] || mv "$folder/bits.tsv" $published
[ $different = 0 ] && echo "${command[*]}: $tried logs have the published bits"
