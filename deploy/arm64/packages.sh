#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the arm64 packages for Debian of what the preset release-arm64 built:
#
#   deploy/arm64/packages.sh BUILD OUT [ARGUMENT...]     further arguments are those of cpack
#
# Which packages they need, dpkg-shlibdeps finds in the sysroot, by a copy of the sysroot's database whose
# files have the paths that they have on this machine.
set -euo pipefail
build=$(realpath "${1:?usage: deploy/arm64/packages.sh BUILD OUT [ARGUMENT...]}")
out=$(realpath -m "${2:?usage: deploy/arm64/packages.sh BUILD OUT [ARGUMENT...]}")
shift 2
sysroot=$(sed -n 's/^WEFT_SYSROOT:[A-Z]*=//p' "$build/CMakeCache.txt" | xargs realpath)

database=$(mktemp -d)
trap 'rm -rf "$database"' EXIT
cp -r "$sysroot/var/lib/dpkg/." "$database"
sed -i "s|^/|$sysroot/|" "$database"/info/*.list
DPKG_ADMINDIR=$database DEB_HOST_ARCH=arm64 \
  LD_LIBRARY_PATH=$sysroot/usr/lib/aarch64-linux-gnu:$sysroot/lib/aarch64-linux-gnu \
  cpack --config "$build/CPackConfig.cmake" -B "$out" "$@"
