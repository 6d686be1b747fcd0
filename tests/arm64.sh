#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes the packages for Debian and the wheel of arm64, and tries them under qemu:
#   - every program and library in them is for arm64, and the wheel has what they load;
#   - weft and weftd of both give the bytes that those of this machine give;
#   - weftd makes no system call that its seccomp profile refuses on arm64;
#   - on a Debian 12 of arm64, which mmdebstrap makes, apt installs the packages, and the tests of
#     tests/python pass with them; the wheel works there, too. Without root, or the right to have the kernel run
#     programs of arm64, this is left out.
#
#   tests/arm64.sh BUILD ARM64 PORTABLE     builds of the presets release, release-arm64, portable-arm64
set -euo pipefail
build=$(realpath "$1") arm64=$(realpath "$2") portable=$(realpath "$3")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
sysroot=$(sed -n 's/^WEFT_SYSROOT:[A-Z]*=//p' "$arm64/CMakeCache.txt" | xargs realpath)
scratch=$(mktemp -d)
trap 'rm -rf --one-file-system "$scratch"' EXIT
say() { printf '==> %s (at %d s)\n' "$*" $SECONDS; }
fail() {
  printf 'arm64.sh: %s\n' "$*" >&2
  exit 1
}

say "packages and wheel"
deploy/arm64/packages.sh "$arm64" "$scratch/packages" >"$scratch/cpack.log" 2>&1 ||
  fail "cpack failed: $(tail "$scratch/cpack.log")"
for deb in "$scratch"/packages/*_arm64.deb; do
  dpkg-deb --extract "$deb" "$scratch/installed"
done
/usr/bin/python3 -B deploy/package/wheels.py "$portable" "$scratch/wheels"
/usr/bin/python3 -B -m wheel unpack "$scratch"/wheels/*_aarch64.whl -d "$scratch" >/dev/null
wheel=$(echo "$scratch"/weftmesh-*)
carried=$wheel/weft/carried
chmod +x "$carried"/bin/*
(cd "$scratch" && du --apparent-size --block-size=1000 packages/*_arm64.deb wheels/*_aarch64.whl)

others=$(find "$scratch/installed" "$carried" -type f -exec file {} + | grep ELF | grep -v 'ARM aarch64' || true)
[[ -z $others ]] || fail "not for arm64: $others"
[[ $(find "$wheel" -path '*licenses*/libclang-common*/copyright') ]] ||
  fail "the wheel lacks the licence of the compiler's headers"

say "meshes, as this machine's"
run=(qemu-aarch64-static -L "$sysroot")
mesh() { # mesh NAME WEFT...
  local name=$1
  shift
  "$@" mesh tests/models/us-east-coast.poly --size '1e-3*(1.5+sin(x)*cos(y))' -o "$scratch/$name.vtu" --json \
    >"$scratch/$name.log" 2>&1 || fail "$name makes no mesh: $(cat "$scratch/$name.log")"
}
server() { # server BIN [OPTION-OF-QEMU...]: makes a program of BIN/weftd, for WEFT_WEFTD
  printf '#!/bin/sh\nexec %s %s/weftd "$@"\n' "${run[*]} ${*:2}" "$1" >"$scratch/weftd"
  chmod +x "$scratch/weftd"
}
WEFT_WEFTD=$build/weftd mesh here "$build/weft"
for bin in "$scratch/installed/usr/bin" "$carried/bin"; do
  server "$bin"
  WEFT_WEFTD=$scratch/weftd mesh arm64 "${run[@]}" "$bin/weft"
  cmp "$scratch/here.vtu" "$scratch/arm64.vtu" || fail "$bin gives another mesh"
done

say "system calls, as the profile has them"
server "$scratch/installed/usr/bin" -strace -D "$scratch/calls"
"$scratch/weftd" --listen "127.0.0.1:0,unix:$scratch/socket" --metrics 127.0.0.1:0 --http 127.0.0.1:0 \
  --data "$scratch/data" --port-file "$scratch/address" 2>"$scratch/server.log" &
server=$!
until [[ -s $scratch/address ]]; do
  kill -0 $server 2>/dev/null || fail "weftd does not start: $(tail "$scratch/server.log")"
  sleep 0.1
done
"$build/weft" submit tests/models/pipe.poly --size 4 --wait --quiet --server "unix:$scratch/socket" >/dev/null
"$build/weft" mesh tests/models/pipe.poly --size 4 -o "$scratch/pipe.vtu" --quiet --server "$(head -n 1 "$scratch/address")"
kill -TERM $server
wait $server || fail "weftd ended with $?: $(tail "$scratch/server.log")"
/usr/bin/python3 - deploy/seccomp/weftd.json "$scratch/calls" <<'END' || fail "the profile refuses what weftd does"
import json, re, sys
profile = json.load(open(sys.argv[1]))
allowed = {name for rule in profile["syscalls"] for name in rule["names"]}
made = set(re.findall(r"^\d+ (\w+)\(", open(sys.argv[2], errors="replace").read(), re.M))
print(f"{len(made)} system calls are made, {len(made - allowed)} of them refused: {sorted(made - allowed)}")
sys.exit("SCMP_ARCH_AARCH64" not in profile["architectures"] or len(made) < 30 or bool(made - allowed))
END

if ((EUID != 0)) || ! deploy/arm64/binfmt.sh; then
  echo "the packages: not installed, for want of root, or of a kernel that runs programs of arm64 by qemu"
  exit
fi

say "a Debian 12 of arm64, by mmdebstrap"
root=$scratch/root
# Python compiles what it imports; to have all compiled that is installed would take qemu a quarter of an hour.
# shellcheck disable=SC2016
mmdebstrap --quiet --variant=minbase --architectures=arm64 \
  --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr --include=usr-is-merged \
  --dpkgopt=path-exclude=/usr/bin/py3compile --customize-hook='cp /usr/bin/py3compile "$1/usr/bin"' \
  --include=python3-pytest,python3-numpy,python3-grpcio,python3-protobuf,python3-pyproj \
  --include=python3-scipy,python3-matplotlib,python3-shapely,python3-meshio,gdal-bin \
  bookworm "$root" >"$scratch/mmdebstrap.log" 2>&1 || fail "mmdebstrap failed: $(tail -n 5 "$scratch/mmdebstrap.log")"

say "apt-get install"
cp /etc/resolv.conf "$root/etc/"
cp -r "$scratch/packages" "$root/srv"
tests/inside.sh "$root" sh -c 'apt-get update -qq && apt-get install -y -qq --no-install-recommends \
  /srv/packages/*_arm64.deb /srv/packages/python3-weft_*.deb' >"$scratch/apt.log" 2>&1 ||
  fail "the packages do not install: $(tail "$scratch/apt.log")"

say "tests of Python"
mkdir "$root/srv/weft"
git ls-files -z --cached --others --exclude-standard | tar --create --null --files-from=- |
  tar --extract --directory="$root/srv/weft"
# What depends on the processor: numbers, arrays, the library by ctypes. Left out are the tests of the network, of
# processes and of examples, which are the same Python anywhere, and of in_process_test three: one needs a C compiler, one
# a machine without libweft, and one makes 11,000 meshes, of which qemu takes 15 GB, or an hour. What qemu keeps of its
# own is bounded, as deploy/arm64/toolchain.cmake says.
tested=(in_process mesh domain as_domain masked triangulate triangle_program receiver periodic layers patches sampling
  formats fields lonlat client)
printf '%s\n' "${tested[@]}" | xargs -P "$(nproc)" -I{} tests/inside.sh "$root" env QEMU_RESERVED_VA=512G \
  PYTHONPYCACHEPREFIX=/var/cache/python MPLBACKEND=agg WEFT_BINARY=/usr/bin/weft WEFT_WEFTD=/usr/bin/weftd \
  WEFT_MODELS=/srv/weft/tests/models WEFT_SOURCE=/srv/weft \
  python3 -m pytest -q -p no:cacheprovider -k 'not (of_the_header or without_a_library or ten_thousand)' \
  '/srv/weft/tests/python/{}_test.py' || fail "tests of Python fail"

say "the wheel"
cp -r "$wheel" "$root/opt/weft"
tests/inside.sh "$root" env PYTHONPATH=/opt/weft python3 -c 'import sys, weft
domain, size = "/srv/weft/tests/models/us-east-coast.poly", "1e-3*(1.5+sin(x)*cos(y))"
with weft.local() as client:
    mesh = client.mesh(domain, size=size)
assert sys.argv[1] == mesh.digest == weft.mesh(domain, size=size).digest
assert weft.__file__.startswith("/opt/weft")' "$(grep -oP '"digest": *"\K\w+' "$scratch/here.log")" ||
  fail "the wheel does not work, or gives another mesh"
echo "packages and wheel of arm64 give the meshes of this machine"
