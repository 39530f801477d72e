#!/usr/bin/env bash
# `pip install .` from a clone, without a package index, into an environment of its own.
# usage: wheel_test.sh FOLDER
set -euo pipefail
folder=$1
source_folder=$(cd "$(dirname "$0")/../.." && pwd)
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
