#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the image of the Dockerfile and runs it, without a Docker daemon and without pulling
# anything: debootstrap makes the base, buildah builds on it and starts the server, and a client
# outside meshes through it. Needs root, for both.
#
#   tests/container.sh WEFT     WEFT is the client to mesh with, such as build/release/weft
#
# Prints the size of the image; fails where it is over 125 MB, where the server runs as root, where
# anything but the volume was written to, where the mesh is wrong or the server does not drain.
set -euo pipefail
weft=$(realpath "${1:?usage: tests/container.sh WEFT}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
((EUID == 0)) || {
  echo "container.sh: needs root, for debootstrap and buildah" >&2
  exit 1
}

scratch=$(mktemp -d)
export STORAGE_DRIVER=vfs BUILDAH_ISOLATION=chroot
buildah=(buildah --root "$scratch/images" --runroot "$scratch/run")
server=
tidy_up() {
  [[ -z $server ]] || kill "$(pid_of_server)" 2>/dev/null || true
  "${buildah[@]}" rm --all >/dev/null 2>&1 || true
  rm -rf "$scratch"
}
trap tidy_up EXIT

say() { printf '==> %s\n' "$*"; }
fail() {
  printf 'container.sh: %s\n' "$*" >&2
  exit 1
}
# Waits half a minute for a command to succeed.
until_true() {
  local tries
  for ((tries = 0; tries < 600; ++tries)); do
    "$@" && return
    sleep 0.05
  done
  return 1
}

say "base: Debian 12, by debootstrap"
debootstrap --variant=minbase bookworm "$scratch/base" >"$scratch/debootstrap.log" 2>&1 ||
  fail "debootstrap failed: $(tail -n 3 "$scratch/debootstrap.log")"
# As Debian's own slim image.
rm -rf "$scratch"/base/usr/share/{doc,man,info,locale,lintian} \
  "$scratch"/base/var/{cache/apt/*,lib/apt/lists/*,log/*}
base=$("${buildah[@]}" from scratch)
"${buildah[@]}" add -q "$base" "$scratch/base" / >/dev/null
"${buildah[@]}" commit -q --rm "$base" weft-base >/dev/null
rm -rf "$scratch/base"

say "image, by buildah"
volumes=()
cache=$(ccache --get-config cache_dir 2>/dev/null) && mkdir -p "$cache" &&
  volumes=(--volume "$cache:/var/cache/ccache")
"${buildah[@]}" build --pull-never --build-arg BASE=localhost/weft-base \
  --build-arg WERROR=ON "${volumes[@]}" \
  --format docker --tag weft . >"$scratch/build.log" 2>&1 ||
  fail "the image does not build: $(tail -n 30 "$scratch/build.log")"
mapfile -t healthcheck < <("${buildah[@]}" inspect --type image weft |
  python3 -c 'import json, sys
print(*json.load(sys.stdin)["Docker"]["config"]["Healthcheck"]["Test"][1:], sep="\n")')
container=$("${buildah[@]}" from --pull-never weft)
root=$("${buildah[@]}" mount "$container")
size=$(du -s --apparent-size --block-size=1000000 "$root" | cut -f1)

# The volume, as a user of the image would find it.
mkdir "$scratch/data"
chown 990:990 "$scratch/data"
chmod 700 "$scratch/data"
in_container() {
  "${buildah[@]}" run --volume "$scratch/data:/var/lib/weft" "$container" -- "$@"
}
# weftd itself, the last descendant of buildah, which does not hand signals on.
pid_of_server() {
  local pid=$server child
  while child=$(pgrep -P "$pid" | head -n 1) && [[ $child ]]; do pid=$child; done
  echo "$pid"
}
listens() { [[ -s $scratch/data/address ]]; }
start_server() {
  rm -f "$scratch/data/address"
  in_container weftd --listen 127.0.0.1:0,unix:/var/lib/weft/socket --metrics 127.0.0.1:0 \
    --port-file /var/lib/weft/address 2>>"$scratch/server.log" &
  server=$!
  until_true listens || fail "the server does not listen: $(tail "$scratch/server.log")"
  address=$(grep -m1 '^127' "$scratch/data/address")
}
stop_server() {
  kill -TERM "$(pid_of_server)"
  wait "$server" || fail "the server ended with $? after SIGTERM: $(tail "$scratch/server.log")"
  server=
}

say "a server in it, a client outside"
start_server
[[ $(stat -c %u "$scratch/data/address") == 990 ]] || fail "the server does not run as user 990"
in_container "${healthcheck[@]}" >/dev/null || fail "the health check fails: ${healthcheck[*]}"
pipe=(tests/models/pipe.poly --size '0.4*hypot(x-200, y-200) + 1')
"$weft" mesh "${pipe[@]}" -o "$scratch/pipe.vtu" --server "$address" --quiet
"$weft" check "$scratch/pipe.vtu" --domain "${pipe[@]}"
job=$("$weft" submit "${pipe[@]}" --wait --server "$address" --quiet)

say "another server on the same volume"
stop_server
start_server
"$weft" fetch "$job" -o "$scratch/fetched.vtu" --server "$address" --quiet
cmp "$scratch/pipe.vtu" "$scratch/fetched.vtu" || fail "the fetched mesh is another one"
stop_server

written=$(find "$root" -xdev -user 990 ! -path "$root/var/lib/weft")
[[ -z $written ]] || fail "written outside of the volume: $written"
echo "image: $size MB"
((size <= 125)) || fail "the image has $size MB, more than 125"
