#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# clang-tidy over the library (core and capi), or over the files that are named.
set -euo pipefail

cd "$(dirname "${BASH_SOURCE[0]}")/.."

readonly FOLDER=build/tidy

case ${1:-} in
  -h | --help)
    cat <<'TEXT'
usage: tools/tidy.sh [FILE...]
  without FILE: all sources of core and capi
  FILE: sources of anything, as build/release compiles them (tools/bootstrap.sh build)
TEXT
    exit 0
    ;;
  -*)
    echo "tidy: there is no option $1; see tools/tidy.sh --help" >&2
    exit 2
    ;;
esac

# $1: folder of compile_commands.json; the files come NUL-separated on stdin; $2...: options
tidy() {
  local build=$1
  shift
  xargs -0 -n 1 -P "$(nproc)" clang-tidy-19 -p "$build" --quiet "$@"
}

if [ $# -gt 0 ]; then
  printf '%s\0' "$@" | tidy build/release
  exit
fi

# Nearly all the time goes into Eigen's headers, once for each file: sixteen sources checked as one take as long as two.
rm -rf $FOLDER
cmake -S . -B $FOLDER -DCMAKE_BUILD_TYPE=Release -DCMAKE_UNITY_BUILD=ON -DCMAKE_UNITY_BUILD_BATCH_SIZE=16 \
  -DUNISIM_BUILD_TESTS=OFF -DUNISIM_BUILD_TOOLS=OFF -DUNISIM_DRIVER_REPLAY=OFF \
  -DUNISIM_DRIVER_GEOMETRIC=OFF -DUNISIM_DRIVER_ONNX=OFF -DUNISIM_DRIVER_LCM=OFF >/dev/null
# The sources are included by a file of CMake's, so findings in them count as those in headers.
find $FOLDER/core $FOLDER/capi -name 'unity_*.cxx' -print0 |
  tidy $FOLDER --checks=-bugprone-suspicious-include --header-filter='/(capi|core)/.*\.(h|hpp|cpp)$'
