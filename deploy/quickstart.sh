#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 machine to a mesh: installs what is missing, builds weftd and weft, starts
# a server, and meshes the flow around a cylinder, finer in its wake, through it.
# Leaves out/cylinder.vtu and out/cylinder.png.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

deploy/install-deps.sh build geo
cmake --preset release
cmake --build --preset release --target weftd weft

scratch=$(mktemp -d)
server=
stop() {
  [[ -z $server ]] || { kill "$server" && wait "$server"; } 2>/dev/null || true
  rm -rf "$scratch"
}
trap stop EXIT

build/release/weftd --listen 127.0.0.1:0 --port-file "$scratch/address" 2>"$scratch/log" &
server=$!
# The file appears, complete, once the server listens.
for ((tries = 0; ; ++tries)); do
  [[ -s $scratch/address ]] && break
  if ! kill -0 "$server" 2>/dev/null || ((tries == 500)); then
    echo "quickstart.sh: weftd did not start; its log:" >&2
    cat "$scratch/log" >&2
    exit 1
  fi
  sleep 0.02
done
address=$(<"$scratch/address")

mkdir -p out
build/release/weft mesh tests/models/cylinder.poly -o out/cylinder.vtu \
  --size '(x>=0 && abs(y)<5) || (x<0 && x^2+y^2<25) ? 1.2e-3 : 1e-2' \
  --draw out/cylinder.png --server "$address"
ls -l out/cylinder.vtu out/cylinder.png
