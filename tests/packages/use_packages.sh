#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# On a system that may be spoilt: installs the packages beside it, builds a C project against them by pkg-config and by
# find_package, has every program say its version, and purges: nothing may be left.
# usage: use_packages.sh VERSION
set -euo pipefail

cd "$(dirname "$0")"
version=$1
export PATH=/usr/sbin:/usr/bin:/sbin:/bin
unset LD_LIBRARY_PATH PKG_CONFIG_PATH CMAKE_PREFIX_PATH

# $*: command, whose words are told only when it fails
quietly() {
  "$@" >log 2>&1 || {
    cat log >&2
    echo "packages: failed: $*" >&2
    exit 1
  }
}
die() {
  echo "packages: $*" >&2
  exit 1
}

# What this system has in other folders must not be taken for what the packages bring.
rm -rf /usr/local/lib/libunisim* /usr/local/include/unisim /usr/local/bin/unisim-*
ldconfig
mapfile -t names < <(for package in *.deb; do dpkg-deb -f "$package" Package; done)
quietly dpkg --install ./*.deb

for program in /usr/bin/unisim-*; do
  [ -e "$program" ] || continue
  said=$("$program" --version)
  case $said in
    "$version" | *" $version") ;;
    *) die "$program --version says \"$said\"" ;;
  esac
  page=/usr/share/man/man1/$(basename "$program").1
  ! command -v help2man >/dev/null || [ -s "$page" ] || die "no manual page $page"
done
for way in find_package pkg-config; do
  quietly cmake -S project -B "built-$way" -DCONSUMER_USES=$way -DCMAKE_BUILD_TYPE=Release
  quietly cmake --build "built-$way"
  for program in "built-$way"/consumer_*; do
    quietly "$program"
  done
done
examples=/usr/share/unisim/examples
if [ -e $examples/camera_lcm.c ]; then
  for example in $examples/{camera_poses,own_source,own_predictor,camera_lcm}.c; do
    # shellcheck disable=SC2046  # flags
    quietly cc -std=c99 "$example" -o "$(basename "$example" .c)" $(pkg-config --cflags --libs unisim_drivers) -lm
  done
  quietly ./own_source
  ! ./camera_lcm /dev/video77 "file://$PWD/poses.lcm?mode=w" >log 2>&1 || die "camera_lcm runs without a camera"
  grep -q '^/dev/video77: ' log || die "camera_lcm says: $(cat log)"
fi

quietly dpkg --purge "${names[@]}"
left=$(find /usr/bin /usr/lib /usr/include /usr/share -path /usr/share/mime -prune -o -iname '*unisim*' -print)
[ -z "$left" ] || die "left after the purge: $left"
echo "packages: made, installed, used and purged"
