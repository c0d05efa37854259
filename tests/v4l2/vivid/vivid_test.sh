#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Starts a kernel with a camera that is not there in an emulated machine and runs the probe in it.
set -euo pipefail

if [ $# -ne 3 ]; then
  echo "usage: vivid_test.sh PROBE KERNEL_FOLDER SCRATCH_FOLDER" >&2
  exit 2
fi
readonly probe=$1 kernel=$2 scratch=$3
# shellcheck source-path=SCRIPTDIR source=../../support/emulated_machine.sh
. "$(dirname "${BASH_SOURCE[0]}")/../../support/emulated_machine.sh"
need_machine "$kernel" modules

# What the machine runs first, and instead of all else.
write_init() {
  init_head >"$1/init"
  cat >>"$1/init" <<'INIT'
while read -r module; do
  [ "$module" = vivid.ko ] || insmod "/modules/$module"
done </modules/order
/load_camera 0
/probe
poweroff -f
INIT
  # $1 of it: number of the device. One webcam, and nothing else of all that vivid can be.
  cat >"$1/load_camera" <<'LOAD'
#!/bin/busybox sh
rmmod vivid 2>/dev/null
insmod /modules/vivid.ko n_devs=1 node_types=0x1 num_inputs=1 input_types=0x0 "vid_cap_nr=$1" &&
  [ -c "/dev/video$1" ]
LOAD
  chmod +x "$1/init" "$1/load_camera"
}

lay_out "$scratch/root" "$kernel/modules"
cp "$probe" "$scratch/root/probe"
write_init "$scratch/root"
pack "$scratch/root" "$scratch/initramfs.gz"
boot "$kernel" "$scratch/initramfs.gz" -m 512 -smp 1 | tee "$scratch/log" | grep -a '^RESULT' || true
if ! grep -aq '^RESULT all is well' "$scratch/log"; then
  echo "the machine's last words:"
  tail -n 20 "$scratch/log"
  exit 1
fi
