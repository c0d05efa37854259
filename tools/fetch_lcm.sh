#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fetches LCM 1.5 from PyPI into a folder, for tests beside the LCM of the system: its Python module, its library, its
# headers and its programs. Nothing is installed.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly VERSION=1.5.3
readonly FOLDER=build/lcm-$VERSION

usage() {
  cat <<TEXT
usage: tools/fetch_lcm.sh
Puts LCM $VERSION for Python 3.11 and this machine's processor into $FOLDER. What is there already is not
fetched again.
TEXT
}

die() {
  printf 'fetch_lcm: %s\n' "$*" >&2
  exit 4
}

# $1: architecture
wheel_sha256() {
  case $1 in
    x86_64) echo 1d4eb1e1a3fe20242a7149d6d56192f652d25701feae18d9774b4f69f10ef445 ;;
    aarch64) echo 92732d4521c05c4c012a51a418287b20c413eca611174c461b3c2801262ccd47 ;;
    *) die "no wheel of LCM $VERSION is known for $1; known are x86_64 and aarch64" ;;
  esac
}

# $1: scratch folder
fetch() {
  local scratch=$1 arch sha256
  arch=$(uname -m)
  sha256=$(wheel_sha256 "$arch")
  printf 'lcm==%s --hash=sha256:%s\n' $VERSION "$sha256" >"$scratch/requirements.txt"
  python3 -m pip download --quiet --disable-pip-version-check --no-deps --only-binary=:all: \
    --implementation cp --python-version 3.11 --platform "manylinux_2_28_$arch" \
    --require-hashes -r "$scratch/requirements.txt" -d "$scratch" >"$scratch/log" 2>&1 ||
    die "pip could not download lcm $VERSION: $(tail -n 1 "$scratch/log")"
  python3 -m zipfile -e "$scratch"/lcm-*.whl "$scratch/made"
  # Files of a wheel come without the right to be run.
  chmod +x "$scratch"/made/bin/*
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
  if [ ! -x $FOLDER/bin/lcm-gen ]; then
    local scratch
    scratch=$(mktemp -d -t unisim-lcm.XXXXXX)
    # shellcheck disable=SC2064  # the folder of now
    trap "rm -rf '$scratch'" EXIT
    fetch "$scratch"
  fi
  printf '%s\n' $FOLDER
}

main "$@"
