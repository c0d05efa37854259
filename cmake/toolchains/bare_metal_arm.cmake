# SPDX-License-Identifier: MIT
# Cross build for Arm Cortex-M7 with no operating system, with Debian's gcc-arm-none-eabi and
# libstdc++-arm-none-eabi-newlib (headers of the C++ library; nothing of it is linked). The static library alone:
# build the target unisim_static with a generator of Makefiles.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(cpu "-mcpu=cortex-m7 -mfpu=fpv5-d16 -mfloat-abi=hard -mthumb -ffunction-sections -fdata-sections")
set(CMAKE_C_FLAGS_INIT "${cpu}")
set(CMAKE_CXX_FLAGS_INIT "${cpu}")
# There is nothing to link a program with.
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
