# Functions of the tests on a fresh Debian or Ubuntu, whose arguments begin with a release,
# bookworm, trixie or noble (Ubuntu 24.04), and a folder.
release=$1
folder=$2

# The base system in $folder/root, with a clone of this project in /root/edmill and nothing else.
fresh_debian() {
  local mirror=http://deb.debian.org/debian options=() script=()
  if [ "$release" = noble ]; then
    # Debian's debootstrap has neither Ubuntu's keys nor a name for this release.
    mirror=http://archive.ubuntu.com/ubuntu
    options=(--components=main,universe --no-check-gpg)
    script=(/usr/share/debootstrap/scripts/gutsy)
  fi
  mirror=${EDMILL_DEBIAN_MIRROR:-$mirror}
  if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
    echo "skipped: needs root and debootstrap"
    exit 77
  fi
  rm -rf "$folder"
  mkdir -p "$folder"
  debootstrap --variant=minbase "${options[@]}" "$release" "$folder/root" "$mirror" "${script[@]}" >"$folder/debootstrap.log"
  # Machines and containers have it; a bare base system does not.
  echo "127.0.0.1 localhost" >"$folder/root/etc/hosts"
  git clone -q "$(dirname "${BASH_SOURCE[0]}")/../.." "$folder/root/root/edmill"
  trap 'umount "$folder/root/proc"' EXIT
  mount -t proc proc "$folder/root/proc"
}

# step NAME COMMAND: runs it in the clone; what it prints is in NAME.log, and shown if it fails.
step() {
  local begin
  begin=$(date +%s)
  chroot "$folder/root" bash -c "cd /root/edmill && $2" >"$folder/$1.log" 2>&1 || {
    tail -40 "$folder/$1.log"
    echo "$release: $2 fails"
    exit 1
  }
  echo "$release: $2, $(($(date +%s) - begin)) s"
}
