#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Starts a kernel with a camera that is not there in an emulated machine and runs the probe in it.
set -euo pipefail

if [ $# -ne 3 ]; then
  echo "usage: vivid_test.sh PROBE KERNEL_FOLDER SCRATCH_FOLDER" >&2
  exit 2
fi
readonly probe=$1 kernel=$2 scratch=$3

skip() {
  echo "skipped: $*"
  exit 0
}

for program in qemu-system-x86_64 busybox cpio; do
  command -v $program >/dev/null || skip "no $program here (tools/bootstrap.sh dev)"
done
[ "$(uname -m)" = x86_64 ] || skip "the kernel that is fetched is for x86-64"
[ -s "$kernel/modules/order" ] || skip "no kernel in $kernel (tools/fetch_kernel.sh)"

# What the machine runs first, and instead of all else.
write_init() {
  cat >"$1/init" <<'INIT'
#!/bin/busybox sh
/bin/busybox mkdir -p /proc /sys /dev
/bin/busybox mount -t proc none /proc
/bin/busybox mount -t sysfs none /sys
/bin/busybox mount -t devtmpfs none /dev
/bin/busybox --install -s /bin
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

pack() {
  rm -rf "$scratch/root"
  mkdir -p "$scratch/root/bin"
  cp "$(command -v busybox)" "$scratch/root/bin/busybox"
  ln -s busybox "$scratch/root/bin/sh"
  cp -r "$kernel/modules" "$scratch/root/modules"
  cp "$probe" "$scratch/root/probe"
  write_init "$scratch/root"
  (cd "$scratch/root" && find . | cpio --quiet -o -H newc | gzip -1) >"$scratch/initramfs.gz"
}

# No acceleration: it would behave otherwise where the host has it.
boot() {
  timeout 500 qemu-system-x86_64 -accel tcg -m 512 -smp 1 -nographic -no-reboot -nodefaults \
    -serial stdio -kernel "$kernel/vmlinuz" -initrd "$scratch/initramfs.gz" \
    -append "console=ttyS0 quiet panic=-1 rdinit=/init" </dev/null 2>&1 | tr -d '\r'
}

mkdir -p "$scratch"
pack
boot | tee "$scratch/log" | grep -a '^RESULT' || true
if ! grep -aq '^RESULT all is well' "$scratch/log"; then
  echo "the machine's last words:"
  tail -n 20 "$scratch/log"
  exit 1
fi
