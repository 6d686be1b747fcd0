#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 machine to a mesh: installs what is missing, builds weftd and weft, starts
# a server, and meshes the flow around a cylinder, finer in its wake, through it.
# Leaves out/cylinder.vtu, out/cylinder.png, and in build/release the programs and the Python package.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

deploy/install-deps.sh build geo python
cmake --preset release
cmake --build --preset release --target weftd weft weft_python

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
echo "
A shell in $PWD finds weft, weftd and the Python package after
  export PATH=\"\$PWD/build/release:\$PATH\" PYTHONPATH=\"\$PWD/build/release/python\"
The pages of the console come with a build where npm is: deploy/install-deps.sh console; deploy/quickstart.sh"
