# SPDX-License-Identifier: MIT
# Build drivers and programs for 64-bit Arm against the packages that tools/fetch_aarch64_sysroot.sh fetches, and run
# them under emulation on SEQUENCE, 40 frames of it, beside the programs of this build in BIN.
include(${CMAKE_CURRENT_LIST_DIR}/../support/library_alone.cmake)
set(sysroot ${ROOT}/build/sysroot-aarch64)
if(NOT EXISTS ${sysroot}/packages)
  message("skipped: no ${sysroot} (tools/fetch_aarch64_sysroot.sh fetches it)")
  return()
endif()
need_programs(aarch64-linux-gnu-gcc aarch64-linux-gnu-g++ qemu-aarch64-static ninja)

configure_all(-G Ninja -DCMAKE_TOOLCHAIN_FILE=${ROOT}/cmake/toolchains/arm64_sysroot.cmake -DEigen3_DIR=${EIGEN}
  -DCMAKE_BUILD_TYPE=Release)
build_library(unisim-replay unisim-live unisim_drivers)
set(emulated qemu-aarch64-static -L ${sysroot})

# run(COMMAND...): it must end with 0. Sets `output`.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT result EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "${command} ends with ${result}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

# require_same_path(HERE THERE): trajectories of both machines, to MOST and their unit of length to 3 %.
function(require_same_path here there)
  run(${BIN}/unisim-eval ate ${here} ${there} --align sim3 --json)
  string(JSON rmse GET "${output}" rmse)
  string(JSON scale GET "${output}" scale)
  string(JSON matched GET "${output}" protocol associated)
  message("${there}: rmse ${rmse}, scale ${scale}, ${matched} poses")
  if(NOT rmse LESS MOST)
    message(FATAL_ERROR "${there} of aarch64 is ${rmse} from that of this machine, at most ${MOST} is meant")
  endif()
  if(NOT scale GREATER 0.97 OR NOT scale LESS 1.03)
    message(FATAL_ERROR "${there} of aarch64 has its unit ${scale} times as large")
  endif()
endfunction()

# require_published(FOLDER LOG MOST_LATE): of the poses of a run, 20 or more, all but MOST_LATE are in its LCM log.
function(require_published folder log most_late)
  file(STRINGS ${folder}/trajectory_live.tum poses REGEX "^[^#]")
  list(LENGTH poses given)
  file(READ ${log} bytes HEX)
  string(REGEX MATCHALL "554e4953494d5f504f5345" published "${bytes}") # UNISIM_POSE
  list(LENGTH published sent)
  math(EXPR late "${given} - ${sent}")
  if(given LESS 20 OR late LESS 0 OR late GREATER most_late)
    message(FATAL_ERROR "of ${given} poses of ${folder} on aarch64 ${sent} are in its LCM log")
  endif()
endfunction()

set(work ${FOLDER}/run)
file(REMOVE_RECURSE ${work})
file(MAKE_DIRECTORY ${work})
set(frames ${SEQUENCE} --from 0 --to 40 --stride 2 --every-frame --quiet --no-report)
set(here ${BIN}/unisim-replay ${frames})
set(there ${emulated} ${FOLDER}/bin/unisim-replay ${frames})

# Predictions that were recorded here give the same bytes there: poses and map.
run(${here} --out ${work}/here --record ${work}/predictions)
set(again --predictor recorded --predictions ${work}/predictions)
run(${here} ${again} --out ${work}/here_again)
run(${there} ${again} --out ${work}/there_again)
foreach(name trajectory.tum trajectory_live.tum trajectory_frames.tum keyframes.csv map.ply)
  file(SHA256 ${work}/here_again/${name} one)
  file(SHA256 ${work}/there_again/${name} other)
  if(NOT one STREQUAL other)
    message(FATAL_ERROR "recorded predictions give another ${name} on aarch64, see ${work}")
  endif()
endforeach()

# From pixels the poses are those of this machine to MOST, and their unit of length to 3 %: the path is 0.30 long, and 0.00001
# and 0.5 % were measured. OpenCV reads, smooths and shrinks images to the same bits there, but its optical flow rounds in
# another order: a few points in a hundred move by a ten thousandth of a pixel.
run(${there} --out ${work}/there --lcm file://${work}/poses.lcm?mode=w)
foreach(name trajectory.tum trajectory_frames.tum)
  require_same_path(${work}/here/${name} ${work}/there/${name})
endforeach()

# Each pose that was given out there was published there.
require_published(${work}/there ${work}/poses.lcm 0)

# A camera there: frames come half a second apart, since the emulated processor is slow, and those it has no time for are
# dropped. What it tracked is recorded, and replayed here it has the poses that were given out there.
file(STRINGS ${SEQUENCE}/rgb.txt listed REGEX "^[^#]")
file(MAKE_DIRECTORY ${work}/camera)
file(CREATE_LINK ${SEQUENCE}/rgb ${work}/camera/rgb SYMBOLIC)
set(list "")
foreach(at RANGE 0 39)
  list(GET listed ${at} line)
  string(REGEX REPLACE "^[^ ]+ " "" image ${line})
  math(EXPR half "${at} % 2 * 5")
  math(EXPR second "1000 + ${at} / 2")
  string(APPEND list "${second}.${half} ${image}\n")
endforeach()
file(WRITE ${work}/camera/rgb.txt "${list}")
run(${emulated} ${FOLDER}/bin/unisim-live --device ${work}/camera --format tum --as-camera --stride 2 --no-report
  --out ${work}/live --lcm file://${work}/live.lcm?mode=w)
string(REGEX MATCH "[0-9]+ poses, from the stamp[^\n]*" ages "${output}")
message("unisim-live on aarch64: ${ages}")
run(${BIN}/unisim-replay ${work}/live/recording --stride 2 --every-frame --quiet --no-report --out ${work}/live_here)
foreach(name trajectory.tum trajectory_frames.tum)
  require_same_path(${work}/live_here/${name} ${work}/live/${name})
endforeach()
# Poses to act by are sent, the few of the frames before the start are not.
require_published(${work}/live ${work}/live.lcm 10)

# The driver of cameras asks the kernel: there is none, or it is listed.
execute_process(COMMAND ${emulated} ${FOLDER}/bin/unisim-live --list
  RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(NOT output MATCHES "no camera found|/dev/video")
  message(FATAL_ERROR "unisim-live --list on aarch64 ends with ${result}: ${output}")
endif()
