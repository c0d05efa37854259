#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# From a fresh Debian 12 or Ubuntu 22.04+ machine to a built, shown and tested libunisim.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly BUILD=build/release
readonly DEMO=build/demo
readonly DEMO_OPTIONS="--scene room --frames 300 --size 640x480 --seed 1 --noise"
readonly PACKAGES="cmake g++ ninja-build pkg-config python3 libeigen3-dev libopencv-dev
  libcli11-dev libtomlplusplus-dev nlohmann-json3-dev catch2 liblcm-dev liblcm-bin
  libcpp-httplib-dev"
readonly CONTRIBUTOR_PACKAGES="ccache dpkg-dev help2man clang clang-format-19 clang-tidy-19 shellcheck doxygen
  python3-numpy python3-opencv python3-pil chromium ffmpeg g++-aarch64-linux-gnu g++-arm-linux-gnueabihf
  g++-riscv64-linux-gnu gcc-arm-none-eabi
  libstdc++-arm-none-eabi-newlib qemu-user-static qemu-system-x86 busybox-static cpio"

usage() {
  cat <<'TEXT'
usage: tools/bootstrap.sh VERB
  demo     install what is missing, build what it needs, render a room, track it, print the error
  test     install what is missing, build, run every test
  build    install what is missing, build into build/release
  deps     install what is missing: packages, and ONNX Runtime into build/onnxruntime
  dev      deps, and what every check needs: formatter, linter, doxygen, browser, other machines'
           compilers and their emulator
  --help   this text
TEXT
}

say() { printf 'bootstrap: %s\n' "$*"; }

die() {
  local code=$1
  shift
  printf 'bootstrap: %s\n' "$*" >&2
  exit "$code"
}

is_installed() {
  [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]
}

# $*: package names
missing_of() {
  local package
  for package in "$@"; do
    is_installed "$package" || printf '%s\n' "$package"
  done
}

# $*: package names
install_packages() {
  if ! command -v apt-get >/dev/null || ! command -v dpkg-query >/dev/null; then
    die 4 "this is no Debian or Ubuntu; install their like of these yourself, then run cmake" \
      "--preset release: $*"
  fi
  local missing
  mapfile -t missing < <(missing_of "$@")
  if [ "${#missing[@]}" -eq 0 ]; then
    return
  fi
  local as_root=()
  if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null ||
      die 4 "neither root nor sudo here; as root run: apt-get install ${missing[*]}"
    as_root=(sudo)
  fi
  say "installing with apt-get: ${missing[*]}"
  local log
  log=$(mktemp -t unisim-bootstrap.XXXXXX)
  if ! { "${as_root[@]}" apt-get update &&
    "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends \
      "${missing[@]}"; } >"$log" 2>&1; then
    die 4 "could not install ${missing[*]}: $(apt_reason "$log") (all of apt's words: $log)"
  fi
  rm -f "$log"
}

# What apt complained of, in one line. $1: its log
apt_reason() {
  local unknown
  unknown=$(sed -n 's/^E: Unable to locate package //p' "$1" | paste -sd ' ')
  if grep -Eq 'Temporary failure resolving|Could not (resolve|connect)|Failed to fetch' "$1"; then
    printf 'the package servers cannot be reached; is the machine offline?'
  elif [ -n "$unknown" ]; then
    printf 'this release of the system does not have %s' "$unknown"
  else
    grep -m1 '^E: ' "$1" || tail -n 1 "$1"
  fi
}

# ONNX Runtime is for the predictors on networks alone: without it all else is built and tested.
onnxruntime() {
  local arch problem
  arch=$(uname -m)
  if [ -f build/onnxruntime/include/onnxruntime_c_api.h ] &&
    [ -e "build/onnxruntime/$arch/lib/libonnxruntime.so.1" ]; then
    return
  fi
  say "fetching ONNX Runtime into build/onnxruntime"
  # In a shell of its own: what cannot be installed ends only that one.
  python3 -m pip --version >/dev/null 2>&1 || (install_packages python3-pip) || true
  if ! problem=$(tools/fetch_onnxruntime.sh 2>&1 >/dev/null); then
    say "going on without ONNX Runtime, --predictor onnx will not run: $problem"
  fi
}

# $*: targets, none: all
build() {
  local options=(--preset release)
  if command -v ninja >/dev/null && [ ! -f $BUILD/Makefile ]; then
    options+=(-G Ninja)
  fi
  if command -v ccache >/dev/null; then
    options+=(-DCMAKE_C_COMPILER_LAUNCHER=ccache -DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  fi
  local targets=()
  if [ $# -gt 0 ]; then
    targets=(--target "$@")
  fi
  say "building ${*:-all} into $BUILD"
  cmake "${options[@]}" >/dev/null
  cmake --build --preset release -j "$(nproc)" "${targets[@]}"
}

# Render the demo's sequence unless it is there, whole, from the same options and renderer.
render() {
  local stamp
  stamp="$($BUILD/bin/unisim-synth --version) $DEMO_OPTIONS"
  if [ "$(cat $DEMO/sequence.options 2>/dev/null)" = "$stamp" ]; then
    say "sequence is there: $DEMO/sequence"
    return
  fi
  say "rendering $DEMO/sequence: $DEMO_OPTIONS"
  rm -f $DEMO/sequence.options
  # shellcheck disable=SC2086  # a list of words
  $BUILD/bin/unisim-synth $DEMO/sequence $DEMO_OPTIONS --force
  printf '%s\n' "$stamp" >$DEMO/sequence.options
}

# Metres from first to last ground-truth pose along the path.
path_length() {
  awk '!/^#/ {
         if (seen++) length_m += sqrt(($2 - x)^2 + ($3 - y)^2 + ($4 - z)^2)
         x = $2; y = $3; z = $4
       }
       END { printf "%.4f", length_m }' "$1"
}

demo() {
  mkdir -p $DEMO
  render
  say "tracking its pixels; focal length and ground truth are not given to the tracker"
  $BUILD/bin/unisim-replay $DEMO/sequence --out $DEMO --force
  local truth=$DEMO/sequence/groundtruth.txt
  say "error against the ground truth:"
  local figures
  figures=$($BUILD/bin/unisim-eval ate $truth $DEMO/trajectory.tum --align sim3)
  printf '%s\n' "$figures"
  local ate
  ate=$(awk '$1 == "rmse" { print $2 }' <<<"$figures")
  awk -v ate="$ate" -v path="$(path_length $truth)" 'BEGIN {
    printf "\nATE RMSE %.4f m on a path of %.2f m: %.2f %%\n", ate, path, 100 * ate / path }'
  printf 'page     %s\nfigures  %s\nposes    %s\nimages   %s\n' "$PWD/$DEMO/report.html" \
    "$PWD/$DEMO/summary.json" "$PWD/$DEMO/trajectory.tum" "$PWD/$DEMO/sequence/rgb"
}

run_tests() {
  ctest --preset release -j "$(nproc)"
}

main() {
  if [ $# -ne 1 ]; then
    usage >&2
    exit 2
  fi
  local verb=$1
  case $verb in
    deps | dev | build | test | demo) ;;
    --help | -h | help)
      usage
      exit 0
      ;;
    *)
      usage >&2
      exit 2
      ;;
  esac
  # shellcheck disable=SC2086  # lists of words
  install_packages $PACKAGES
  onnxruntime
  case $verb in
    dev)
      # shellcheck disable=SC2086
      install_packages $CONTRIBUTOR_PACKAGES
      say "all packages are there"
      ;;
    deps) say "all packages are there" ;;
    build) build ;;
    test)
      build
      run_tests
      ;;
    demo)
      build unisim-synth unisim-replay unisim-eval
      demo
      ;;
  esac
}

main "$@"
