#!/usr/bin/env bash
# The README's commands on a fresh Debian or Ubuntu: its base system, a clone, and nothing else. Needs root, debootstrap and a mirror.
# usage: debian_test.sh RELEASE FOLDER COMMAND...   e.g. debian_test.sh trixie /tmp/trixie demo test
#        RELEASE: bookworm, trixie, or noble (Ubuntu 24.04)
set -euo pipefail
release=$1
folder=$2
mirror=http://deb.debian.org/debian
options=()
script=()
if [ "$release" = noble ]; then
  # Debian's debootstrap has neither Ubuntu's keys nor a name for this release.
  mirror=http://archive.ubuntu.com/ubuntu
  options=(--components=main,universe --no-check-gpg)
  script=(/usr/share/debootstrap/scripts/gutsy)
fi
mirror=${EDMILL_DEBIAN_MIRROR:-$mirror}
source_folder=$(cd "$(dirname "$0")/../.." && pwd)
if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
  echo "skipped: needs root and debootstrap"
  exit 77
fi
rm -rf "$folder"
mkdir -p "$folder"
debootstrap --variant=minbase "${options[@]}" "$release" "$folder/root" "$mirror" "${script[@]}" >"$folder/debootstrap.log"
# Machines and containers have it; a bare base system does not.
echo "127.0.0.1 localhost" >"$folder/root/etc/hosts"
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
  # What packages say while they are installed is theirs.
  if sed '1,/^== configuring/d' "$folder/$command.log" | grep -iE "warning:|CMake (Deprecation )?Warning"; then
    echo "$release: ./bootstrap.sh $command warns"
    exit 1
  fi
  echo "$release: ./bootstrap.sh $command, $(($(date +%s) - begin)) s"
done
