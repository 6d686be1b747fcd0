#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the packages for Debian and the wheel of arm64, and tries them under qemu:
#   - every program and library in them is for arm64, and the wheel has what they load;
#   - weft and weftd of both give the bytes that those of this machine give.
#
#   tests/arm64.sh BUILD ARM64 PORTABLE     builds of the presets release, release-arm64, portable-arm64
set -euo pipefail
build=$(realpath "$1") arm64=$(realpath "$2") portable=$(realpath "$3")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
sysroot=$(sed -n 's/^WEFT_SYSROOT:[A-Z]*=//p' "$arm64/CMakeCache.txt" | xargs realpath)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
fail() {
  printf 'arm64.sh: %s\n' "$*" >&2
  exit 1
}

deploy/arm64/packages.sh "$arm64" "$scratch/packages" >"$scratch/cpack.log" 2>&1 ||
  fail "cpack failed: $(tail "$scratch/cpack.log")"
for deb in "$scratch"/packages/*_arm64.deb; do
  dpkg-deb --extract "$deb" "$scratch/installed"
done
/usr/bin/python3 -B deploy/package/wheels.py "$portable" "$scratch/wheels"
/usr/bin/python3 -B -m wheel unpack "$scratch"/wheels/*_aarch64.whl -d "$scratch" >/dev/null
carried=$(echo "$scratch"/weftmesh-*/weft/carried)
chmod +x "$carried"/bin/*

others=$(find "$scratch/installed" "$carried" -type f -exec file {} + | grep ELF | grep -v 'ARM aarch64' || true)
[[ -z $others ]] || fail "not for arm64: $others"

run=(qemu-aarch64-static -L "$sysroot")
mesh() { # mesh NAME WEFT...
  local name=$1
  shift
  "$@" mesh tests/models/us-east-coast.poly --size '1e-3*(1.5+sin(x)*cos(y))' -o "$scratch/$name.vtu" \
    >"$scratch/$name.log" 2>&1 || fail "$name makes no mesh: $(cat "$scratch/$name.log")"
}
WEFT_WEFTD=$build/weftd mesh here "$build/weft"
for bin in "$scratch/installed/usr/bin" "$carried/bin"; do
  printf '#!/bin/sh\nexec %s %s/weftd "$@"\n' "${run[*]}" "$bin" >"$scratch/weftd"
  chmod +x "$scratch/weftd"
  WEFT_WEFTD=$scratch/weftd mesh arm64 "${run[@]}" "$bin/weft"
  cmp "$scratch/here.vtu" "$scratch/arm64.vtu" || fail "$bin gives another mesh"
done
echo "packages and wheel of arm64 give the meshes of this machine"
