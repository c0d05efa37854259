#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fetches a kernel of Debian and its camera that is not there (vivid), for tests in an emulator. Nothing is
# installed; apt checks what it downloads.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly FOLDER=build/kernel
readonly DRIVER=vivid

usage() {
  cat <<TEXT
usage: tools/fetch_kernel.sh
Puts vmlinuz, the modules that $DRIVER needs and the order to load them in into $FOLDER. What is there
already is not fetched again.
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

# $1: scratch folder
fetch() {
  local scratch=$1 package file
  package=$(package_name)
  if [ -z "$package" ]; then
    die "apt knows no package linux-image-amd64: this is made for Debian on x86-64 (apt-get update?)"
  fi
  (cd "$scratch" && apt-get download "$package" >log 2>&1) ||
    die "apt could not download $package: $(tail -n 1 "$scratch/log")"
  dpkg-deb -x "$scratch/$package"_*.deb "$scratch/system"
  mkdir -p "$scratch/made/modules"
  cp "$scratch"/system/boot/vmlinuz-* "$scratch/made/vmlinuz"
  module_and_needs "$scratch/system/lib/modules" $DRIVER | awk '!seen[$0]++' >"$scratch/files"
  while read -r file; do
    cp "$file" "$scratch/made/modules/"
    basename "$file" >>"$scratch/made/modules/order"
  done <"$scratch/files"
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
  if [ -s $FOLDER/modules/order ]; then
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
