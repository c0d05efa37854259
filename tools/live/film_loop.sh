# SPDX-License-Identifier: MIT
# shellcheck shell=bash
# Sourced by latency.sh and soak.sh.

# Absolute path of the folder $1; ends with one line where there is none.
folder_of_images() {
  [ -d "$1" ] || {
    echo "$(basename "$0" .sh): $1: no such folder" >&2
    exit 3
  }
  realpath "$1"
}

# A sequence in TUM format at 30 frames a second: forwards, backwards, forwards, so that the camera never jumps.
# $1: folder it is made in  $2: folder of images, an absolute path  $3: pattern of their names  $4: frames
film_loop() {
  local folder=$1 images=$2 pattern=$3 frames=$4
  mkdir "$folder"
  ln -s "$images" "$folder/rgb"
  find "$images/" -maxdepth 1 -name "$pattern" -printf 'rgb/%f\n' | sort >"$folder/names"
  if [ "$(wc -l <"$folder/names")" -lt 100 ]; then
    echo "$(basename "$0" .sh): $images: fewer than 100 images match $pattern" >&2
    exit 3
  fi
  awk -v frames="$frames" '
    { name[NR - 1] = $0 }
    END {
      for (k = 0; k < frames; ++k) {
        at = k % (2 * NR - 2)
        printf "%.6f %s\n", 1000 + k / 30, name[at < NR ? at : 2 * NR - 2 - at]
      }
    }' "$folder/names" >"$folder/rgb.txt"
}
