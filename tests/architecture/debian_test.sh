#!/usr/bin/env bash
# The README's commands on a fresh Debian: its base system, a clone, and nothing else. Needs root, debootstrap and a mirror.
# usage: debian_test.sh RELEASE FOLDER COMMAND...   e.g. debian_test.sh trixie /tmp/trixie demo test
set -euo pipefail
release=$1
folder=$2
mirror=${EDMILL_DEBIAN_MIRROR:-http://deb.debian.org/debian}
source_folder=$(cd "$(dirname "$0")/../.." && pwd)
if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
  echo "skipped: needs root and debootstrap"
  exit 77
fi
rm -rf "$folder"
mkdir -p "$folder"
debootstrap --variant=minbase "$release" "$folder/root" "$mirror" >"$folder/debootstrap.log"
git clone -q "$source_folder" "$folder/root/root/edmill"
trap 'umount "$folder/root/proc"' EXIT
mount -t proc proc "$folder/root/proc"
for command in "${@:3}"; do
  begin=$(date +%s)
  chroot "$folder/root" bash -c "cd /root/edmill && ./bootstrap.sh $command" >"$folder/$command.log" 2>&1 || {
    tail -40 "$folder/$command.log"
    echo "$release: ./bootstrap.sh $command fails"
    exit 1
  }
  if grep -n "warning:" "$folder/$command.log"; then
    echo "$release: ./bootstrap.sh $command warns"
    exit 1
  fi
  echo "$release: ./bootstrap.sh $command, $(($(date +%s) - begin)) s"
done
