#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# How old a pose is when it is given out, and when another program has it: from the stamp of the frame on, as with a
# camera of 30 frames a second. A trial for people and their boards, no test.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: tools/live/latency.sh FOLDER_OF_IMAGES [SECONDS]
  plays FOLDER_OF_IMAGES/* (sorted) back and forth as a camera of 30 frames/s for SECONDS (60) through unisim-live,
  once by itself and once with --lcm and a consumer in another process, and prints how old the poses were
  environment: BUILD (build/release), PATTERN (*.color.*), ARGUMENTS of unisim-live
TEXT
}

if [ $# -eq 0 ] || [ "$1" = --help ]; then
  usage
  exit $(($# > 0 ? 0 : 2))
fi
# shellcheck source-path=SCRIPTDIR source=film_loop.sh
. "$(dirname "${BASH_SOURCE[0]}")/film_loop.sh"
images=$(folder_of_images "$1")
seconds=${2:-60}
build=${BUILD:-build/release}
pattern=${PATTERN:-*.color.*}
readonly URL='udpm://239.255.76.67:7691?ttl=0'
work=$(mktemp -d -t unisim-latency.XXXXXX)
consumer=
# shellcheck disable=SC2317  # by the trap
clean_up() {
  [ -z "$consumer" ] || kill "$consumer" 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT

film_loop "$work/loop" "$images" "$pattern" $((seconds * 30))

# $*: further arguments of unisim-live
play() {
  # shellcheck disable=SC2086  # a list
  "$build/bin/unisim-live" --device "$work/loop" --format tum --as-camera ${ARGUMENTS:-} "$@" >"$work/log" 2>&1 || {
    tail -n 5 "$work/log" >&2
    echo 'latency: unisim-live failed' >&2
    exit 1
  }
  tr '\r' '\n' <"$work/log" | grep 'frames/s' | tail -n 1 | sed 's/^/  at the end: /'
  sed -n 's/^unisim-live: \(.*from the stamp.*\)/  unisim-live: \1/p' "$work/log"
}

echo "load before: $(cut -d' ' -f1-3 /proc/loadavg), $(nproc) processors"
echo 'without LCM'
play
echo 'with LCM'
"$build/examples/unisim-lcm-pose-age" $((seconds * 30)) "$URL" >"$work/ages" &
consumer=$!
play --lcm "$URL"
wait "$consumer" || true
consumer=
sed -n '/poses,/s/^/  consumer:    /p' "$work/ages"
