#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds the images of the Dockerfile by deploy/image.sh and runs them, without a Docker daemon and
# without pulling anything. Needs root, as image.sh does.
#
#   tests/container.sh WEFT [ARM64]     WEFT is the client to mesh with, such as build/release/weft
#
# With ARM64, a folder that the preset release-arm64 built, the images are those for arm64, which qemu runs, without
# a browser.
#
# weftd: buildah starts the server, and a client outside meshes through it. Fails if the image is over
# 120 MB (135 for arm64, of which Debian itself takes 98 instead of 84) or has the client, if the server
# runs as root, if anything but the volume was written to, if the mesh is wrong or not that of WEFT, if the
# health check succeeds without a server, if the server does not drain, or if it has no console; it only
# says so if the console has no pages, because npm got no packages. If tests/console has its packages, too,
# a browser works with the image's console: a mesh, a polygon drawn by hand, a cancelled run, a killed
# server, a token. WEFT_ALL_PAGES=1 runs every test of the browser.
#
# weft: meshes files of the user who runs it, with what GDAL, PROJ and METIS are for, on a server of its
# own. Prints the sizes of both.
set -euo pipefail
weft=$(realpath "${1:?usage: tests/container.sh WEFT [ARM64]}")
arm64=() suffix='' limit=120
[[ ! ${2:-} ]] || arm64=(--arm64 "$(realpath "$2")") suffix=-arm64 limit=135
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

deploy/image.sh "${arm64[@]}" "$scratch" --build-arg WERROR=ON
# A value of an image's configuration, a list, one item per line: config_of IMAGE KEY...
config_of() {
  "${buildah[@]}" inspect --type image "$1" | python3 -c 'import functools, json, sys
config = json.load(sys.stdin)["Docker"]["config"]
print(*functools.reduce(dict.__getitem__, sys.argv[1:], config), sep="\n")' "${@:2}"
}
size_of() { du -s --apparent-size --block-size=1000000 "$1" | cut -f1; }

mapfile -t healthcheck < <(config_of weftd$suffix Healthcheck Test)
unset "healthcheck[0]" # CMD
container=$("${buildah[@]}" from --pull-never weftd$suffix)
root=$("${buildah[@]}" mount "$container")
size=$(size_of "$root")
[[ $(config_of weftd$suffix Entrypoint) == weftd ]] || fail "weftd does not start weftd"
client_files=$(find "$root" -xdev \( -path '*/bin/weft' -o -name 'lib*gdal*.so*' -o -name 'libproj.so*' \
  -o -name 'libmetis.so*' -o -name 'libcairo.so*' -o -name '*.ttf' \))
[[ -z $client_files ]] || fail "the image weftd has files of the client: $client_files"

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
    --console 127.0.0.1:0 --port-file /var/lib/weft/address 2>>"$scratch/server.log" &
  server=$!
  until_true listens || fail "the server does not listen: $(tail "$scratch/server.log")"
  address=$(grep -m1 '^127' "$scratch/data/address")
}
stop_server() {
  kill -TERM "$(pid_of_server)"
  wait "$server" || fail "the server ended with $? after SIGTERM: $(tail "$scratch/server.log")"
  server=
}

say "weftd: a server in it, a client outside"
in_container "${healthcheck[@]}" >/dev/null 2>&1 && fail "the health check succeeds without a server"
start_server
[[ $(stat -c %u "$scratch/data/address") == 990 ]] || fail "the server does not run as user 990"
in_container "${healthcheck[@]}" >/dev/null || fail "the health check fails: ${healthcheck[*]}"
pipe=(tests/models/pipe.poly --size '0.4*hypot(x-200, y-200) + 1')
"$weft" mesh "${pipe[@]}" -o "$scratch/pipe.vtu" --server "$address" --quiet
"$weft" check "$scratch/pipe.vtu" --domain "${pipe[@]}"
"$weft" mesh "${pipe[@]}" -o "$scratch/here.vtu" --quiet
cmp "$scratch/pipe.vtu" "$scratch/here.vtu" || fail "the image makes another mesh than $weft"
job=$("$weft" submit "${pipe[@]}" --wait --server "$address" --quiet)
python3 - "$(sed -n 's/^console=//p' "$scratch/data/address")" "$scratch/no-pages" <<'END' || fail "the console is not served"
import re, sys, urllib.request
get = lambda path: urllib.request.urlopen(f"http://{sys.argv[1]}{path}", timeout=30).read().decode()
page = get("/")
if "built without the console's pages" in page:
    open(sys.argv[2], "w").close()
    sys.exit(print("the image has no pages of the console: npm got no packages"))
scripts = re.findall(r'src="(/assets/[^"]*)"', page)
assert scripts and all(get(script) for script in scripts), page
END

say "weftd: another server on the same volume"
stop_server
start_server
"$weft" fetch "$job" -o "$scratch/fetched.vtu" --server "$address" --quiet
cmp "$scratch/pipe.vtu" "$scratch/fetched.vtu" || fail "the fetched mesh is another one"
stop_server

written=$(find "$root" -xdev -user 990 ! -path "$root/var/lib/weft")
[[ -z $written ]] || fail "written outside of the volume: $written"

# The browser's tests start weftd themselves: by a program that enters the image, with this machine's
# /tmp, which has the tests' folders.
if [[ ! $suffix && -d tests/console/node_modules && ! -e $scratch/no-pages ]]; then
  say "weftd: its console in a browser"
  mkdir "$scratch/programs"
  ln -s "$weft" "$scratch/programs/weft"
  cat >"$scratch/programs/weftd" <<END
#!/bin/sh
exec unshare --mount sh -c 'for folder in dev proc tmp; do
  mount --rbind "/\$folder" "\$0/\$folder" || exit
done
exec chroot "\$0" weftd "\$@"' "$root" "\$@"
END
  chmod +x "$scratch/programs/weftd"
  some=(--test-name-pattern='dropped file is meshed|drawn by hand|is cancelled|killed server|a token')
  [[ -z ${WEFT_ALL_PAGES:-} ]] || some=()
  (cd tests/console && WEFT_PROGRAMS=$scratch/programs timeout 1800 \
    node --test --test-reporter=spec "${some[@]}" mesh.test.js pages.test.js) ||
    fail "the console of the image does not work in a browser"
fi

say "weft: meshes of a GeoPackage in longitude and latitude, in parts, by user 1000"
mapfile -t entrypoint < <(config_of weft$suffix Entrypoint)
client=$("${buildah[@]}" from --pull-never weft$suffix)
client_size=$(size_of "$("${buildah[@]}" mount "$client")")
mkdir "$scratch/mounted"
ogr2ogr "$scratch/mounted/coast.gpkg" tests/models/us-east-coast.geojson
chown -R 1000:1000 "$scratch/mounted"
# As where a server is configured for others; the private one must not use it.
in_client() {
  "${buildah[@]}" run --user 1000:1000 --env WEFT_DATA=/var/lib/weft --volume "$scratch/mounted:/work" \
    "$client" -- "${entrypoint[@]}" "$@"
}
coast=(--size 1e8 --lonlat --to-metres)
in_client mesh coast.gpkg "${coast[@]}" -o coast.vtu --draw coast.png --quiet 2>"$scratch/client.log"
[[ ! -s $scratch/client.log ]] || fail "weft --quiet is not quiet: $(cat "$scratch/client.log")"
# There, because another processor's sines would project it otherwise, in the last bits.
in_client check coast.vtu --domain coast.gpkg "${coast[@]}"
in_client mesh coast.gpkg "${coast[@]}" -o parts.vtu --parts 2 --quiet
[[ $(stat -c %u "$scratch/mounted/coast.vtu") == 1000 ]] || fail "the mesh is not user 1000's"

echo "images$suffix: weftd $size MB, weft $client_size MB"
((size <= limit)) || fail "the image weftd has $size MB, more than $limit"
