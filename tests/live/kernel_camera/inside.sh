#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs in the emulated machine: unisim-live on the camera that play_mjpeg feeds, a consumer of LCM beside it.
# inside.sh FOLDER_OF_PROGRAMS CONSUMER PLAYER WIDTHxHEIGHT MILLISECONDS, in the folder that is shared with the host
set -u
readonly bin=$1 consumer=$2 player=$3 size=$4 period=$5
readonly url='udpm://239.255.76.67:7691?ttl=0'
"$player" /dev/video0 "${size%x*}" "${size#*x}" "$period" go <list >player.log 2>&1 &
playing=$!
"$consumer" 1000000 "$url" >poses.log &
consuming=$!
sleep 1
"$bin/unisim-live" --list >cameras.log 2>&1
"$bin/unisim-live" --device /dev/video0 --size "$size" --lcm "$url" --out out --no-report >live.log 2>&1 &
tracking=$!
for _ in $(seq 300); do
  grep -q '/dev/video0 (.*MJPG' live.log && break
  sleep 0.1
done
touch go
wait "$playing"
echo "player ended with $?" >>player.log
kill -TERM "$tracking"
wait "$tracking"
sleep 1
kill -TERM "$consuming"
