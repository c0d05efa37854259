#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A recording is played as an MJPG camera of a real kernel, in an emulated machine, into unisim-live; a consumer of LCM in
# another process has every pose once and in order, and the recording of the run has the same poses here.
#   FRAMES=FILE  a list of JPEG images in place of rendered ones, SIZE and PERIOD (milliseconds) of them
set -euo pipefail

if [ $# -ne 5 ]; then
  echo "usage: kernel_camera_test.sh FOLDER_OF_PROGRAMS CONSUMER PLAYER KERNEL_FOLDER SCRATCH_FOLDER" >&2
  exit 2
fi
# Names as they are from any folder, for the machine.
bin=$(realpath "$1")
consumer=$(realpath "$2")
player=$(realpath "$3")
readonly bin consumer player kernel=$4 scratch=$5
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
readonly here
# shellcheck source-path=SCRIPTDIR source=../../support/emulated_machine.sh
. "$here/../../support/emulated_machine.sh"
need_machine "$kernel" loopback
# The emulated processor is some fifty times as slow: frames come late enough for it.
readonly size=${SIZE:-320x240} period=${PERIOD:-500}

fail() {
  echo "$*"
  tail -n 20 "$scratch/log" "$share/live.log" "$share/player.log"
  exit 1
}

# The host's files, as they are, with one folder to write to.
write_init() {
  init_head >"$1/init"
  cat >>"$1/init" <<INIT
while read -r module; do
  insmod "/modules/\$module"
done </modules/order
mkdir -p /host
mount -t 9p -o trans=virtio,version=9p2000.L,ro,cache=loose,msize=262144 host /host
mount -t 9p -o trans=virtio,version=9p2000.L,msize=262144 share /host/mnt
for each in proc sys dev; do mount -o bind /\$each /host/\$each; done
ip link set lo up
ip route add 224.0.0.0/4 dev lo
chroot /host /bin/bash -c 'cd /mnt && $here/inside.sh $bin $consumer $player $size $period'
poweroff -f
INIT
  chmod +x "$1/init"
}

readonly share=$scratch/share
rm -rf "$share"
mkdir -p "$share"
if [ -n "${FRAMES:-}" ]; then
  cp "$FRAMES" "$share/list"
else
  # A slow walk, of which a frame in three is enough.
  "$bin/unisim-synth" "$scratch/film" --scene room --frames 300 --size "$size" --jpg --quiet --force
  find "$scratch/film/rgb" -name '*.jpg' | sort | head -n 80 >"$share/list"
fi
lay_out "$scratch/root" "$kernel/loopback"
write_init "$scratch/root"
pack "$scratch/root" "$scratch/initramfs.gz"
boot "$kernel" "$scratch/initramfs.gz" -cpu Nehalem -m 1536 -smp 2 \
  -virtfs local,path=/,mount_tag=host,security_model=none,readonly=on,multidevs=remap \
  -virtfs "local,path=$share,mount_tag=share,security_model=none" >"$scratch/log" || true

grep -q 'player ended with 0' "$share/player.log" || fail 'the film was not played to its end'
grep -q 'MJPG' "$share/cameras.log" || fail 'unisim-live --list does not show the camera'
ages=$(sed -n 's/^unisim-live: \([0-9]* poses, from the stamp.*\)/\1/p' <(tr '\r' '\n' <"$share/live.log"))
given=${ages%% *}
[ "${given:-0}" -ge 10 ] || fail "unisim-live gave out ${given:-no} poses"
sed -n 's/^pose utime \([0-9]*\) .*/\1/p' "$share/poses.log" >"$scratch/heard"
sort -nu "$scratch/heard" | cmp -s - "$scratch/heard" || fail 'poses came twice, or out of order'
heard=$(wc -l <"$scratch/heard")
[ "$heard" -eq "$given" ] || fail "of $given poses $heard reached the consumer"

# Both processors round otherwise: see tests/cross/check_drivers.cmake.
"$bin/unisim-replay" "$share/out/recording" --every-frame --quiet --no-report --force --out "$scratch/again" \
  >"$scratch/replayed"
rmse=$("$bin/unisim-eval" ate "$scratch/again/trajectory_frames.tum" "$share/out/trajectory_frames.tum" --json |
  sed -n 's/^ *"rmse": \([^,]*\),*$/\1/p')
awk -v rmse="$rmse" 'BEGIN { exit !(rmse != "" && rmse < 0.001) }' || fail "replayed here the poses are $rmse off"
echo "$ages; $heard at the consumer, once and in order; replayed here $rmse off"
