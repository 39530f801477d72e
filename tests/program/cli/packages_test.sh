#!/usr/bin/env bash
# The packages install and run in a Debian that has nothing else, of the release on which they are
# made. Needs root, debootstrap and a mirror.
# usage: packages_test.sh BUILD FOLDER
set -euo pipefail
build=$(realpath "$1")
folder=$(realpath -m "$2")
mirror=${EDMILL_DEBIAN_MIRROR:-http://deb.debian.org/debian}
if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
  echo "skipped: needs root and debootstrap"
  exit 77
fi
rm -rf "$folder"
mkdir -p "$folder/packages"
"$(dirname "$0")/../../../docs/sphinx/make.sh" "$build/manual" >"$folder/manual.log"
(cd "$build" && cpack -B "$folder/packages" >"$folder/cpack.log")
release=$(. /etc/os-release && echo "$VERSION_CODENAME")
debootstrap --variant=minbase "$release" "$folder/root" "$mirror" >"$folder/debootstrap.log"
trap 'umount "$folder/root/proc"' EXIT
mount -t proc proc "$folder/root/proc"
mkdir "$folder/root/packages"
cp "$folder"/packages/*.deb "$folder/root/packages"
inside() { chroot "$folder/root" "$@"; }
inside apt-get update -qq
DEBIAN_FRONTEND=noninteractive inside sh -c 'apt-get install -y -qq --no-install-recommends /packages/*.deb' >"$folder/install.log" 2>&1

inside edmill --version
inside sh -c 'cd /tmp && edmill demo --quiet && test -s out/demo/report.html'
inside python3 -c "
import edmill
rate = edmill.run(edmill.Case.spex8000(balls=28, diameter='4.76 mm'), until='2 s').milling_dose_rate
print(rate, 'W')
assert 5 < rate < 7"
# The manual's tutorial, with nothing but the packages; the machine time that it takes is printed.
cp "$(dirname "$0")/../../manual/pages_test.py" "$folder/root/tmp"
time inside python3 /tmp/pages_test.py /usr/bin/edmill /usr/lib/python3/dist-packages /usr/share/doc/edmill /tmp/tutorial docs/tutorial.md
inside test -s /usr/share/doc/edmill/html/index.html
inside test -s /usr/share/man/man1/edmill.1 -o -s /usr/share/man/man1/edmill.1.gz
inside sh -c 'cp /usr/share/doc/edmill/docs/examples/own_observer.cpp /tmp &&
  cd /tmp && apt-get install -y -qq --no-install-recommends pkg-config >/dev/null 2>&1 &&
  g++ own_observer.cpp $(pkg-config --cflags --libs edmill) -o own_observer &&
  ./own_observer /usr/share/doc/edmill/docs/examples/demo.toml'
echo "the packages install and run"
