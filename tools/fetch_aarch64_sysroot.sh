#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fetches what the drivers need of Debian for 64-bit Arm (OpenCV, LCM) into a folder, to build for a board and to run
# what was built under an emulator. Nothing is installed, and this machine's own apt is left as it is.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=private_apt.sh
. tools/private_apt.sh

readonly SYSROOT=build/sysroot-aarch64
readonly PACKAGES="libc6-dev libstdc++-12-dev libopencv-dev liblcm-dev libcli11-dev libtomlplusplus-dev
  nlohmann-json3-dev libcpp-httplib-dev"
# A file says which packages lie there: another list is fetched anew.
readonly STAMP=$SYSROOT/packages

usage() {
  cat <<TEXT
usage: tools/fetch_aarch64_sysroot.sh
Puts files of Debian's packages for arm64 ($PACKAGES, and all that these need) into
$SYSROOT: some 200 MB are downloaded, 1 GB lies there. What is there already is not fetched again.
TEXT
}

die() {
  printf 'fetch_aarch64_sysroot: %s\n' "$*" >&2
  exit 4
}

# The compiler's libraries must not be older than the packages.
check_release() {
  local release
  # shellcheck disable=SC1091  # of the system
  release=$(. /etc/os-release && printf '%s %s' "${ID:-}" "${VERSION_CODENAME:-}")
  [ "$release" = 'debian bookworm' ] ||
    die "this is made for Debian 12 (the compiler's libraries must not be older than the packages), here is $release"
}

# Links that name a file from the root of a system are made to name it from where they lie. $1: sysroot
make_links_relative() {
  local link target
  find "$1" -type l -lname '/*' -print | while read -r link; do
    target=$(readlink "$link")
    ln -sfn "$(realpath -sm --relative-to="$(dirname "$link")" "$1$target")" "$link"
  done
}

# What the system's update-alternatives would link, which is asked of no other machine's packages: the plain BLAS and
# LAPACK, which OpenCV is linked to. $1: sysroot
link_alternatives() {
  local libraries=$1/usr/lib/aarch64-linux-gnu name
  for name in blas lapack; do
    [ -e "$libraries/$name/lib$name.so.3" ] || die "no lib$name among the packages"
    ln -sfn "$name/lib$name.so.3" "$libraries/lib$name.so.3"
  done
}

# $1: scratch folder
fetch() {
  local scratch=$1 made=$1/made package
  check_release
  # Signatures are checked with the keys of Debian that are on this machine.
  write_apt_configuration "$scratch" bookworm arm64
  export APT_CONFIG=$scratch/apt.conf
  # shellcheck disable=SC2086  # a list
  { apt-get -q update && apt-get -q -y --download-only install $PACKAGES; } >"$scratch/log" 2>&1 ||
    die "apt could not download $PACKAGES for arm64: $(tail -n 1 "$scratch/log")"
  mkdir -p "$made"
  for package in "$scratch"/cache/archives/*.deb; do
    # No programs, no documents: less to unpack.
    dpkg-deb --fsys-tarfile "$package" | tar -x -C "$made" --exclude='./usr/share/doc' --exclude='./usr/share/man' \
      --exclude='./usr/share/locale' --exclude='./usr/bin' --exclude='./usr/sbin' --exclude='./dev'
  done
  # On a whole system these are links to the folders under usr.
  if [ -d "$made/lib" ] && [ ! -L "$made/lib" ]; then
    cp -a "$made/lib/." "$made/usr/lib/"
    rm -rf "${made:?}/lib"
  fi
  ln -sfn usr/lib "$made/lib"
  make_links_relative "$made"
  link_alternatives "$made"
  echo "$PACKAGES" >"$made/packages"
  mkdir -p "$(dirname $SYSROOT)"
  rm -rf $SYSROOT
  mv "$made" $SYSROOT
}

main() {
  if [ $# -gt 0 ]; then
    usage
    [ "$1" = --help ] && exit 0
    exit 2
  fi
  if [ "$(cat $STAMP 2>/dev/null)" != "$PACKAGES" ]; then
    local scratch
    scratch=$(mktemp -d -p "${TMPDIR:-/tmp}" unisim-sysroot.XXXXXX)
    # shellcheck disable=SC2064  # the folder of now
    trap "rm -rf '$scratch'" EXIT
    fetch "$scratch"
  fi
  printf '%s\n' $SYSROOT
}

main "$@"
