#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes the Debian packages of a build, looks at what they depend on, and has them used (use_packages.sh) on a copy of
# this system whose changes go to memory and end with it.
# usage: check_packages.sh BUILD VERSION CONSUMER_PROJECT
set -euo pipefail

here=$(dirname "$(realpath "$0")")
skip() {
  echo "skipped: $*"
  exit 0
}
die() {
  echo "packages: $*" >&2
  exit 1
}

for tool in dpkg-deb dpkg-shlibdeps cpack; do
  command -v "$tool" >/dev/null || skip "no $tool here"
done
if [ "${IN_NAMESPACE:-}" != yes ]; then
  [ "$(id -u)" -eq 0 ] || skip "installing takes root"
  unshare --mount true 2>/dev/null || skip "not allowed to make a mount namespace"
  IN_NAMESPACE=yes exec unshare --mount "$0" "$@"
fi

build=$1
version=$2
project=$3
work=$(mktemp -d -t unisim-packages.XXXXXX)
trap 'cd /; umount -R "$work" 2>/dev/null; rmdir "$work"' EXIT
mount -t tmpfs tmpfs "$work"
root="$work/root"
mkdir "$work/upper" "$work/scratch" "$root"
mount -t overlay overlay -o "lowerdir=/,upperdir=$work/upper,workdir=$work/scratch" "$root" \
  2>/dev/null || skip "no overlay of this system's files can be mounted"
mount --bind /dev "$root/dev"
mount -t proc proc "$root/proc"

if ! (cd "$build" && cpack -G DEB -B "$work/made") >"$work/log" 2>&1; then
  cat "$work/log" >&2
  die "cpack failed"
fi
mapfile -t packages < <(find "$work/made" -maxdepth 1 -name '*.deb')
[ "${#packages[@]}" -ge 2 ] || die "cpack made ${#packages[@]} packages"
for package in "${packages[@]}"; do
  echo "$(dpkg-deb -f "$package" Package) needs: $(dpkg-deb -f "$package" Depends)"
done

# What a package depends on. $1: package
needs() {
  dpkg-deb -f "$(find "$work/made" -maxdepth 1 -name "$1_*.deb" | grep .)" Depends
}
needs libunisim0 | grep -Eq '^libc6 \([^,]*$' || die "libunisim0 needs more than libc6"
needs libunisim-dev | grep -q "libunisim0 (= $version)" || die "libunisim-dev needs no libunisim0"
if ls "$work"/made/unisim-tools_* >/dev/null 2>&1; then
  needs unisim-tools | grep -q libopencv-core || die "unisim-tools needs no OpenCV"
  needs unisim-tools | grep -q 'libunisim0' || die "unisim-tools needs no libunisim0"
fi
if dpkg-deb -c "$work"/made/libunisim-dev_*.deb | grep -q camera_lcm; then
  needs libunisim-drivers0 | grep -q liblcm || die "libunisim-drivers0 needs no LCM"
fi

mkdir "$root/packages"
cp "${packages[@]}" "$here/use_packages.sh" "$root/packages"
cp -r "$project" "$root/packages/project"
chroot "$root" /packages/use_packages.sh "$version"
