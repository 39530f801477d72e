#!/usr/bin/env bash
# `pip install .` from a clone, without a package index, into an environment of its own; and a wheel
# that holds the libraries that it needs, installed for an interpreter that is not Debian's, if
# there is one of the same version, and in a Debian that has only Python and NumPy (needs root,
# debootstrap and a mirror).
# usage: wheel_test.sh FOLDER
set -euo pipefail
folder=$1
source_folder=$(cd "$(dirname "$0")/../../.." && pwd)
rm -rf "$folder"
mkdir -p "$folder"
git clone -q "$source_folder" "$folder/clone"
/usr/bin/python3 -m venv --system-site-packages "$folder/venv"
"$folder/venv/bin/pip" install -q --no-index --no-deps "$folder/clone"
cd "$folder"
venv/bin/python -c "
import edmill
print(edmill.__file__)
print(edmill.run(edmill.Case.spex8000(balls=28, diameter='4.76 mm'), until='2 s').milling_dose_rate, 'W')"

command -v patchelf >/dev/null || { echo "no wheel with libraries: patchelf is absent" && exit 0; }
venv/bin/pip wheel -q --no-index --no-deps --config-settings=libraries=bundled ./clone -w wheels
ls -l wheels
version=$(/usr/bin/python3 -c 'import sys; print("{}.{}".format(*sys.version_info))')
for python in ${EDMILL_OTHER_PYTHON:-"${PYENV_ROOT:-$HOME/.pyenv}/versions/$version".*/bin/python3}; do
  [ -x "$python" ] || { echo "not tried with another interpreter: none of version $version (EDMILL_OTHER_PYTHON)" && continue; }
  "$python" -m venv other
  ln -s "$(/usr/bin/python3 -c 'import numpy, os; print(os.path.dirname(numpy.__file__))')" other/lib/python*/site-packages
  other/bin/pip install -q --no-index --no-deps wheels/*.whl
  (cd other && bin/python -c "
import sys, edmill
rate = edmill.run(edmill.Case.spex8000(balls=28, diameter='4.76 mm'), until='2 s').milling_dose_rate
print(sys.version, rate, 'W')
assert 5 < rate < 7")
  rm -r other
done
[ "$(id -u)" = 0 ] && command -v debootstrap >/dev/null || { echo "not tried elsewhere: needs root and debootstrap" && exit 0; }
debootstrap --variant=minbase --include=python3,python3-numpy,python3-pip "$(. /etc/os-release && echo "$VERSION_CODENAME")" root \
  "${EDMILL_DEBIAN_MIRROR:-http://deb.debian.org/debian}" >debootstrap.log
cp wheels/*.whl root/tmp
chroot root sh -c 'pip install -q --no-index --no-deps --break-system-packages /tmp/*.whl && cd /tmp && python3 -c "
import edmill
rate = edmill.run(edmill.Case.spex8000(balls=28, diameter=\"4.76 mm\"), until=\"2 s\").milling_dose_rate
print(rate, \"W\")
assert 5 < rate < 7"'
