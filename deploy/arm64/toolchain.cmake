# SPDX-License-Identifier: Apache-2.0
# clang and lld compile for arm64 on another machine, with what deploy/arm64/sysroot.sh unpacked; tests run
# under qemu. Programs that the build itself runs, such as protoc, are this machine's.
set(CMAKE_SYSTEM_NAME Linux)
set(CMAKE_SYSTEM_PROCESSOR aarch64)
set(CMAKE_LIBRARY_ARCHITECTURE aarch64-linux-gnu)
set(CMAKE_C_COMPILER clang)
set(CMAKE_C_COMPILER_TARGET aarch64-linux-gnu)
set(CMAKE_CXX_COMPILER_TARGET aarch64-linux-gnu)

list(APPEND CMAKE_TRY_COMPILE_PLATFORM_VARIABLES WEFT_SYSROOT)
if(NOT EXISTS ${WEFT_SYSROOT})
  message(FATAL_ERROR "There is no ${WEFT_SYSROOT}, which deploy/arm64/sysroot.sh makes")
endif()
set(CMAKE_SYSROOT ${WEFT_SYSROOT})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
set(ENV{PKG_CONFIG_SYSROOT_DIR} ${WEFT_SYSROOT})
set(ENV{PKG_CONFIG_LIBDIR}
  ${WEFT_SYSROOT}/usr/lib/aarch64-linux-gnu/pkgconfig:${WEFT_SYSROOT}/usr/share/pkgconfig)

foreach(kind EXE SHARED MODULE)
  set(CMAKE_${kind}_LINKER_FLAGS_INIT -fuse-ld=lld)
endforeach()

# -R: qemu 7.2 keeps 6 MB of its own for each GiB of addresses that was ever reserved. In a room of this size those are 3 GB
# at most, and nine runs find place at a time. TEST_SLOWDOWN is for tests/support/processor_time.h.
set(CMAKE_CROSSCOMPILING_EMULATOR
  qemu-aarch64-static -R 512G -E TEST_SLOWDOWN=20 -L ${WEFT_SYSROOT})
