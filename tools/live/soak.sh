#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Plays a recording back and forth for a while through unisim-live with all that a robot uses, and says what
# became of memory, of the age of the poses and of the frames. A trial for people and slow machines, no test.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: tools/live/soak.sh FOLDER_OF_IMAGES [MINUTES]
  plays FOLDER_OF_IMAGES/* (sorted) back and forth as a camera of 30 frames/s for MINUTES (30) through unisim-live with
  --lcm --web --out, somebody looking at the page, and prints a line every half minute and the figures
  environment: UNISIM_LIVE (build/release/bin/unisim-live), PATTERN (*.color.*), ARGUMENTS of unisim-live
TEXT
}

if [ $# -eq 0 ] || [ "$1" = --help ]; then
  usage
  exit $(($# > 0 ? 0 : 2))
fi
# shellcheck source-path=SCRIPTDIR source=film_loop.sh
. "$(dirname "${BASH_SOURCE[0]}")/film_loop.sh"
images=$(folder_of_images "$1")
minutes=${2:-30}
live=${UNISIM_LIVE:-build/release/bin/unisim-live}
pattern=${PATTERN:-*.color.*}
work=$(mktemp -d -t unisim-soak.XXXXXX)
pid=
watcher=
# shellcheck disable=SC2317  # by the trap
clean_up() {
  [ -z "$watcher" ] || kill "$watcher" 2>/dev/null || true
  [ -z "$pid" ] || kill "$pid" 2>/dev/null || true
  rm -rf "$work"
}
trap clean_up EXIT

film_loop "$work/loop" "$images" "$pattern" $((minutes * 60 * 30))

read -ra more <<<"${ARGUMENTS:-}"
"$live" --device "$work/loop" --format tum --as-camera --out "$work/out" --no-record-images --web 0 \
  --lcm "udpm://239.255.76.67:7667?ttl=0" "${more[@]}" >"$work/log" 2>&1 &
pid=$!
url=
for _ in $(seq 100); do
  url=$(sed -n 's/^page: //p' "$work/log")
  [ -z "$url" ] || break
  sleep 0.1
done
curl -sN "${url}events" >/dev/null &
watcher=$!

sample() { awk '/VmRSS/ { printf "%.1f MB", $2 / 1000 }' "/proc/$pid/status" 2>/dev/null || true; }
SECONDS=0
next=30
while kill -0 "$pid" 2>/dev/null; do
  sleep 1
  if [ $SECONDS -ge $next ]; then
    next=$((next + 30))
    figures=$(timeout 5 curl -sN --max-time 2 "${url}events" 2>/dev/null | sed -n 's/^data: {"source".*"frames":/frames /p' |
      sed 's/"//g; s/,stages.*//' | tail -n 1) || true
    printf '%4d s  memory %s  %s\n' $SECONDS "$(sample)" "$figures"
  fi
done
result=0
wait "$pid" || result=$?
pid=
grep -v '^tracking' "$work/log" | tail -n 25
echo "unisim-live ended with $result after $SECONDS s"
exit "$result"
