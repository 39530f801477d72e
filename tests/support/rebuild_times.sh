#!/usr/bin/env bash
# Prints the seconds until the program is linked again after a change of one line, for each of some
# sources.
#
# usage: rebuild_times.sh BUILD SOURCE...    BUILD is complete; every source is as it was afterwards
set -euo pipefail
build=$1
shift
for source in "$@"; do
  kept=$(mktemp)
  cp -p "$source" "$kept"
  trap 'cp -p "$kept" "$source"' EXIT
  echo "// changed" >>"$source"
  start=$SECONDS
  cmake --build "$build" --target edmill_cli >/dev/null
  echo "$source $((SECONDS - start)) s"
  cp "$kept" "$source"
  trap - EXIT
  cmake --build "$build" --target edmill_cli >/dev/null
done
