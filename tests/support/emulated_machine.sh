# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Sourced by tests that start a kernel in an emulated machine.

skip() {
  echo "skipped: $*"
  exit 0
}

# Ends the test where the emulator, or the modules $2 of the kernel in folder $1, are not there.
need_machine() {
  local program
  for program in qemu-system-x86_64 busybox cpio; do
    command -v $program >/dev/null || skip "no $program here (tools/bootstrap.sh dev)"
  done
  [ "$(uname -m)" = x86_64 ] || skip "the kernel that is fetched is for x86-64"
  [ -s "$1/$2/order" ] || skip "no $2 in $1 (tools/fetch_kernel.sh)"
}

# A folder with busybox, modules and an empty list of all else. $1: folder to make  $2: folder of modules
lay_out() {
  rm -rf "$1"
  mkdir -p "$1/bin"
  cp "$(command -v busybox)" "$1/bin/busybox"
  ln -s busybox "$1/bin/sh"
  cp -r "$2" "$1/modules"
}

# What /init of every machine begins with.
init_head() {
  cat <<'INIT'
#!/bin/busybox sh
/bin/busybox mkdir -p /proc /sys /dev
/bin/busybox mount -t proc none /proc
/bin/busybox mount -t sysfs none /sys
/bin/busybox mount -t devtmpfs none /dev
/bin/busybox --install -s /bin
INIT
}

# $1: folder that lay_out() made  $2: file to write
pack() {
  (cd "$1" && find . | cpio --quiet -o -H newc | gzip -1) >"$2"
}

# No acceleration: it would behave otherwise where the host has it.
# $1: folder of the kernel  $2: file of pack()  others: options of the emulator
boot() {
  local folder=$1 files=$2
  shift 2
  timeout 500 qemu-system-x86_64 -accel tcg -nographic -no-reboot -nodefaults -serial stdio \
    -kernel "$folder/vmlinuz" -initrd "$files" -append "console=ttyS0 quiet panic=-1 rdinit=/init" "$@" </dev/null 2>&1 |
    tr -d '\r'
}
