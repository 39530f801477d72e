#!/usr/bin/env bash
# Makes everything that a release consists of, with the same bytes each time from the same commit:
# packages of Debian, a wheel for Python, the npm package, the page of the mill, the reference
# suite, the manual and the site. Needs `./bootstrap.sh install release`.
# usage: make.sh FOLDER    about half an hour on two cores
set -euo pipefail
source_folder=$(cd "$(dirname "$0")/.." && pwd)
folder=$(mkdir -p "$1" && cd "$1" && pwd)
work=$source_folder/build/release-artefacts
rm -rf "$work"
mkdir -p "$work"
cd "$source_folder"
if [ -n "$(git status --porcelain --untracked-files=no)" ]; then
  echo "the tree has changes that are not committed" >&2
  exit 1
fi
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH LC_ALL=C TZ=UTC
say() { printf '== %s\n' "$*"; }

say "npm package and page"
release/npm.sh build/page >/dev/null # where the manual and the site look for the page
cp build/page/edmill-*.tgz build/page/edmill.html "$folder"

say "reference suite"
release/suite.sh "$folder" >/dev/null

say "manual and site"
docs/sphinx/make.sh "$work/manual" >/dev/null
docs/site/make.sh "$work/site" "$work/manual" >/dev/null
find "$work/site" -name .buildinfo -delete
tar --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner -C "$work" -cf - site | gzip -9n >"$folder/edmill-site.tar.gz"

say "wheel"
python3 -m pip wheel --quiet --no-deps --no-build-isolation --config-settings=libraries=bundled -w "$folder" . ||
  python3 -m pip wheel --quiet --no-deps --config-settings=libraries=bundled -w "$folder" .

say "packages of Debian"
git clone -q . "$work/debian/edmill"
(cd "$work/debian/edmill" && DEB_BUILD_OPTIONS=noautodbgsym dpkg-buildpackage -us -uc -b >"$work/debian/log" 2>&1) || {
  tail -30 "$work/debian/log" >&2
  exit 1
}
cp "$work"/debian/*.deb "$folder"

cd "$folder"
find . -maxdepth 1 -type f ! -name SHA256SUMS -printf '%P\n' | sort | xargs sha256sum >SHA256SUMS
cat SHA256SUMS
