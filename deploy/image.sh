#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds both targets of the Dockerfile, as localhost/weftd and localhost/weft, without a Docker daemon
# and without pulling anything: debootstrap makes the base, buildah builds on it. Needs root, for both.
#
#   deploy/image.sh STORAGE [ARGUMENT...]     further arguments are those of `buildah build`
#
# Images are kept in the folder STORAGE, which is made; `buildah --root STORAGE/images --runroot
# STORAGE/run`, with STORAGE_DRIVER=vfs, finds them there.
set -euo pipefail
storage=${1:?usage: deploy/image.sh STORAGE [ARGUMENT...]}
shift
mkdir -p "$storage"
storage=$(realpath "$storage")
cd "$(dirname "${BASH_SOURCE[0]}")/.."
export STORAGE_DRIVER=vfs BUILDAH_ISOLATION=chroot
buildah=(buildah --root "$storage/images" --runroot "$storage/run")
fail() {
  printf 'image.sh: %s\n' "$*" >&2
  exit 1
}

echo "==> base: Debian 12, by debootstrap"
debootstrap --variant=minbase bookworm "$storage/base" >"$storage/debootstrap.log" 2>&1 ||
  fail "debootstrap failed: $(tail -n 3 "$storage/debootstrap.log")"
# As Debian's own slim image.
rm -rf "$storage"/base/usr/share/{doc,man,info,locale,lintian} \
  "$storage"/base/var/{cache/apt/*,lib/apt/lists/*,log/*}
base=$("${buildah[@]}" from scratch)
"${buildah[@]}" add -q "$base" "$storage/base" / >/dev/null
"${buildah[@]}" commit -q --rm "$base" weft-base >/dev/null
rm -rf "$storage/base"

# What arguments of `buildah build` make; the programs are compiled once.
build() {
  "${buildah[@]}" build --pull-never --build-arg BASE=localhost/weft-base --format docker "$@" . \
    >>"$storage/build.log" 2>&1 ||
    fail "the images do not build: $(tail -n 30 "$storage/build.log")"
}
echo "==> programs, by buildah"
volumes=()
cache=$(ccache --get-config cache_dir 2>/dev/null) && mkdir -p "$cache" &&
  volumes=(--volume "$cache:/var/cache/ccache")
# npm, which makes the console's pages, trusts there whom this machine trusts.
authorities=/etc/ssl/certs/ca-certificates.crt
[[ ! -f $authorities ]] ||
  volumes+=(--volume "$authorities:/authorities.crt:ro" --build-arg NODE_EXTRA_CA_CERTS=/authorities.crt)
build "${volumes[@]}" --target programs --tag weft-programs "$@"
for target in weftd weft; do
  echo "==> image $target"
  build --build-arg PROGRAMS=localhost/weft-programs --target $target --tag $target "$@"
done
