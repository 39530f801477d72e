#!/usr/bin/env bash
# debian/ makes packages on a fresh Debian that lintian finds without errors, and that pass
# debian/tests on another one that has only these packages. Needs root, debootstrap and a mirror.
# usage: debian_package_test.sh RELEASE FOLDER   e.g. debian_package_test.sh trixie /tmp/trixie
set -euo pipefail
. "$(dirname "$0")/fresh_debian.sh"
fresh_debian
cp -a --one-file-system "$folder/root" "$folder/bed"
mv "$folder/bed" "$folder/root"
version=$(sed -n '1s/.*(\(.*\)-.*/\1/p' "$folder/root/root/edmill/debian/changelog")
git -C "$folder/root/root/edmill" archive --format=tar.gz --prefix="edmill-$version/" -o "../edmill_$version.orig.tar.gz" \
  HEAD . ':!debian'
export DEBIAN_FRONTEND=noninteractive
install="apt-get install -y -qq --no-install-recommends"
step tools "apt-get update -qq && $install autopkgtest fakeroot lintian"
step dependencies "apt-get build-dep -y -qq --no-install-recommends ./"
step build "dpkg-buildpackage -us -uc --post-clean"
step lintian "lintian --fail-on error ../*.changes"
cat "$folder/lintian.log"
step autopkgtest "autopkgtest -B ../*.deb ./ -- chroot /bed"
sed '1,/ summary$/d' "$folder/autopkgtest.log" | grep PASS
