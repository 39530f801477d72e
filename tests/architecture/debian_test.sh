#!/usr/bin/env bash
# The README's commands on a fresh Debian or Ubuntu: its base system, a clone, and nothing else.
# Needs root, debootstrap and a mirror.
# usage: debian_test.sh RELEASE FOLDER COMMAND...   e.g. debian_test.sh trixie /tmp/trixie demo test
#        RELEASE: bookworm, trixie, or noble (Ubuntu 24.04)
set -euo pipefail
. "$(dirname "$0")/fresh_debian.sh"
fresh_debian
for command in "${@:3}"; do
  step "$command" "./bootstrap.sh $command"
  # What packages say while they are installed is theirs.
  if sed '1,/^== configuring/d' "$folder/$command.log" | grep -iE "warning:|CMake (Deprecation )?Warning"; then
    echo "$release: ./bootstrap.sh $command warns"
    exit 1
  fi
done
