#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Fetches ONNX Runtime, library and C header, from PyPI and Debian: pinned by hash, nothing is installed.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."
# shellcheck source-path=SCRIPTDIR source=private_apt.sh
. tools/private_apt.sh

readonly NEWEST=1.31.1
readonly HEADER_PACKAGE=libonnxruntime-dev=1.21.0+dfsg-1
readonly HEADER_SHA256=14f7d959d5deacbcf1504830d4189f91fc67382b399ed9ae9d3aa9c4050ced08
readonly HEADER_FOLDER=build/onnxruntime/include

usage() {
  cat <<TEXT
usage: tools/fetch_onnxruntime.sh [VERSION [ARCH]]
  VERSION  $NEWEST (default) or 1.21.0, the oldest that runs
  ARCH     x86_64 or aarch64 (default: this machine's)
Puts the library of $NEWEST into build/onnxruntime/ARCH, of others into build/onnxruntime/ARCH-VERSION,
the header into $HEADER_FOLDER. What is there already is not fetched again.
TEXT
}

die() {
  printf 'fetch_onnxruntime: %s\n' "$*" >&2
  exit 4
}

# $1: version, $2: architecture
wheel_sha256() {
  case $1-$2 in
    1.31.1-x86_64) echo 5752bd508126ae7c49894d3b9d2e83f0c3d487319246d04c444b393308d7ad7f ;;
    1.31.1-aarch64) echo da05378364c44d4407e463982d2bf8d5e4cfea873283757e48beeb41df97b7f3 ;;
    1.21.0-x86_64) echo 8a5d09815a9e209fa0cb20c2985b34ab4daeba7aea94d0f96b8751eb10403201 ;;
    1.21.0-aarch64) echo 7f9156cf6f8ee133d07a751e6518cf6f84ed37fbf8243156bd4a2c4ee6e073c8 ;;
    *) die "no hash is known of version $1 for $2; known are $NEWEST and 1.21.0, x86_64 and aarch64" ;;
  esac
}

# $1: version, $2: architecture, $3: folder to fill, $4: scratch folder
fetch_library() {
  local version=$1 arch=$2 target=$3 scratch=$4 sha256
  sha256=$(wheel_sha256 "$version" "$arch")
  printf 'onnxruntime==%s --hash=sha256:%s\n' "$version" "$sha256" >"$scratch/requirements.txt"
  # The interpreter is named because a wheel needs one; the library inside does not.
  python3 -m pip download --quiet --disable-pip-version-check --no-deps --only-binary=:all: \
    --implementation cp --python-version 3.11 --platform "manylinux_2_28_$arch" \
    --platform "manylinux_2_27_$arch" --require-hashes -r "$scratch/requirements.txt" \
    -d "$scratch" >"$scratch/log" 2>&1 ||
    die "pip could not download onnxruntime $version: $(tail -n 1 "$scratch/log")"
  python3 -m zipfile -e "$scratch"/onnxruntime-*.whl "$scratch/wheel"
  mkdir -p "$scratch/made/lib"
  cp "$scratch/wheel/onnxruntime/capi/libonnxruntime.so.$version" "$scratch/made/lib/"
  cp "$scratch/wheel/onnxruntime/LICENSE" "$scratch/wheel/onnxruntime/ThirdPartyNotices.txt" \
    "$scratch/made/"
  ln -s "libonnxruntime.so.$version" "$scratch/made/lib/libonnxruntime.so.1"
  mkdir -p "$(dirname "$target")"
  rm -rf "$target"
  mv "$scratch/made" "$target"
}

# The header is the same on every architecture. $1: scratch folder
fetch_header() {
  local scratch=$1
  # The package is checked by its hash, so that the archive's key need not be known here.
  write_apt_configuration "$scratch" '[trusted=yes] trixie' amd64
  (
    cd "$scratch"
    export APT_CONFIG=$scratch/apt.conf
    apt-get -q update && apt-get -q download "$HEADER_PACKAGE"
  ) >"$scratch/log" 2>&1 || die "apt could not download $HEADER_PACKAGE: $(tail -n 1 "$scratch/log")"
  local package
  package=$(echo "$scratch"/libonnxruntime-dev_*.deb)
  echo "$HEADER_SHA256  $package" | sha256sum --check --quiet >/dev/null 2>&1 ||
    die "$HEADER_PACKAGE is not the file that was pinned; report this"
  dpkg-deb -x "$package" "$scratch/deb"
  mkdir -p "$HEADER_FOLDER"
  cp "$scratch/deb/usr/include/onnxruntime/onnxruntime_c_api.h" "$HEADER_FOLDER/"
}

main() {
  if [ "${1:-}" = --help ] || [ "${1:-}" = -h ]; then
    usage
    exit 0
  fi
  if [ $# -gt 2 ]; then
    usage >&2
    exit 2
  fi
  local version=${1:-$NEWEST}
  local arch=${2:-$(uname -m)}
  local target=build/onnxruntime/$arch
  [ "$version" = "$NEWEST" ] || target+=-$version
  wheel_sha256 "$version" "$arch" >/dev/null
  local scratch
  scratch=$(mktemp -d -t unisim-onnxruntime.XXXXXX)
  # shellcheck disable=SC2064  # the folder of now
  trap "rm -rf '$scratch'" EXIT
  [ -f "$HEADER_FOLDER/onnxruntime_c_api.h" ] || fetch_header "$scratch"
  [ -f "$target/lib/libonnxruntime.so.$version" ] ||
    fetch_library "$version" "$arch" "$target" "$scratch"
  printf '%s\n' "$target"
}

main "$@"
