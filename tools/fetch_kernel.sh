#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fetches a kernel of Debian and two cameras that are not there, for tests in an emulator: its own (vivid) and one that
# plays what a program writes (v4l2loopback, compiled here). Nothing is installed; apt checks what it downloads.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly FOLDER=build/kernel
readonly DRIVER=vivid
# What a machine needs that sees files of the host and has a camera to play to.
readonly PLAYED='virtio_pci 9pnet_virtio 9p videodev'

usage() {
  cat <<TEXT
usage: tools/fetch_kernel.sh
Puts vmlinuz, the modules that $DRIVER needs and the order to load them in into $FOLDER, and into $FOLDER/loopback
those of a machine with v4l2loopback. What is there already is not fetched again.
TEXT
}

die() {
  printf 'fetch_kernel: %s\n' "$*" >&2
  exit 4
}

# Newest kernel for this machine's processor, as the name of its package.
package_name() {
  apt-cache depends linux-image-amd64 2>/dev/null |
    sed -n 's/^ *Depends: \(linux-image-[0-9][^ ]*\)$/\1/p' | head -n 1
}

# $1: folder of modules, $2: name of a module, with - or _. Prints its file.
module_file() {
  find "$1" -name "${2//[-_]/[-_]}.ko" -print -quit
}

# Prints the files of a module and before it all it needs, some more than once.
# $1: folder of modules, $2: name
module_and_needs() {
  local file needs need
  file=$(module_file "$1" "$2")
  if [ -z "$file" ]; then
    die "this kernel has no module $2"
  fi
  needs=$(tr '\0' '\n' <"$file" | sed -n 's/^depends=//p' | tr ',' ' ')
  for need in $needs; do
    module_and_needs "$1" "$need"
  done
  printf '%s\n' "$file"
}

# $1: scratch folder, others: packages
download() {
  local scratch=$1 package
  shift
  (cd "$scratch" && apt-get download "$@" >log 2>&1) || die "apt could not download $*: $(tail -n 1 "$scratch/log")"
  for package in "$@"; do
    dpkg-deb -x "$scratch/$package"_*.deb "$scratch/system"
  done
}

# Copies modules and what they need, and the order to load them in. $1: scratch folder, $2: to where, others: modules
take_modules() {
  local scratch=$1 folder=$2 name file
  shift 2
  mkdir -p "$folder"
  for name in "$@"; do
    module_and_needs "$scratch/system/lib/modules" "$name"
  done | awk '!seen[$0]++' >"$scratch/files"
  while read -r file; do
    cp "$file" "$folder/"
    basename "$file" >>"$folder/order"
  done <"$scratch/files"
}

# Compiles the loopback camera for the kernel. $1: scratch folder, $2: version of the kernel, $3: to where
compile_loopback() {
  local sources=$1/system/usr/src version=$2 release=${2%%-*}
  download "$1" "linux-headers-$version" "linux-headers-${version%-amd64}-common" "linux-kbuild-${release%.*}" \
    v4l2loopback-dkms
  # The headers name where they would be installed.
  sed -i "s#/usr/src#$sources#" "$sources/linux-headers-$version/Makefile"
  mkdir "$1/loopback"
  cp "$sources"/v4l2loopback-*/*.[ch] "$1/loopback/"
  echo 'obj-m := v4l2loopback.o' >"$1/loopback/Kbuild"
  make -C "$sources/linux-headers-$version" M="$1/loopback" modules >"$1/log" 2>&1 ||
    die "v4l2loopback could not be compiled: $(grep -m 1 -i error "$1/log" || tail -n 1 "$1/log")"
  strip -d "$1/loopback/v4l2loopback.ko" -o "$3/v4l2loopback.ko"
  echo v4l2loopback.ko >>"$3/order"
}

# $1: scratch folder
fetch() {
  local scratch=$1 package
  package=$(package_name)
  if [ -z "$package" ]; then
    die "apt knows no package linux-image-amd64: this is made for Debian on x86-64 (apt-get update?)"
  fi
  download "$scratch" "$package"
  take_modules "$scratch" "$scratch/made/modules" $DRIVER
  cp "$scratch"/system/boot/vmlinuz-* "$scratch/made/vmlinuz"
  # shellcheck disable=SC2086  # a list
  take_modules "$scratch" "$scratch/made/loopback" $PLAYED
  compile_loopback "$scratch" "${package#linux-image-}" "$scratch/made/loopback"
  mkdir -p "$(dirname $FOLDER)"
  rm -rf $FOLDER
  mv "$scratch/made" $FOLDER
}

main() {
  if [ $# -gt 0 ]; then
    usage
    [ "$1" = --help ] && exit 0
    exit 2
  fi
  if [ -s $FOLDER/modules/order ] && [ -s $FOLDER/loopback/v4l2loopback.ko ]; then
    return
  fi
  local scratch
  scratch=$(mktemp -d -t unisim-kernel.XXXXXX)
  # shellcheck disable=SC2064  # the folder of now
  trap "rm -rf '$scratch'" EXIT
  # apt downloads as a user of its own, where it is root's.
  chmod 755 "$scratch"
  fetch "$scratch"
}

main "$@"
