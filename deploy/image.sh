#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Builds both targets of the Dockerfile, as localhost/weftd and localhost/weft, without a Docker daemon
# and without pulling anything: debootstrap, or mmdebstrap, makes the base, buildah builds on it. Needs root.
#
#   deploy/image.sh [--arm64 BUILD] STORAGE [ARGUMENT...]     further arguments are those of `buildah build`
#
# With --arm64 the images are localhost/weftd-arm64 and localhost/weft-arm64, of the programs in BUILD, a folder
# that the preset release-arm64 built: qemu runs what apt installs, but compiles nothing.
#
# Images are kept in the folder STORAGE, which is made; `buildah --root STORAGE/images --runroot
# STORAGE/run`, with STORAGE_DRIVER=vfs, finds them there.
set -euo pipefail
usage="usage: deploy/image.sh [--arm64 BUILD] STORAGE [ARGUMENT...]"
processor=$(dpkg --print-architecture) arm64='' suffix=''
if [[ ${1:-} == --arm64 ]]; then
  processor=arm64 arm64=$(realpath "${2:?$usage}") suffix=-arm64
  shift 2
fi
storage=${1:?$usage}
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
# image_of FOLDER NAME: an image of the folder alone, which is deleted
image_of() {
  local container
  container=$("${buildah[@]}" from --arch "$processor" scratch)
  "${buildah[@]}" config --arch "$processor" "$container"
  "${buildah[@]}" add -q "$container" "$1" / >/dev/null
  "${buildah[@]}" commit -q --rm "$container" "$2" >/dev/null
  rm -rf "$1"
}

bootstrap=(debootstrap)
if [[ $arm64 ]]; then
  deploy/arm64/binfmt.sh || fail "this machine runs no programs of arm64"
  # Unlike debootstrap, it does not unpack by qemu. usrmerge, which it would take, brings perl.
  bootstrap=(mmdebstrap --architectures=arm64 --hook-dir=/usr/share/mmdebstrap/hooks/merged-usr --include=usr-is-merged)
fi
echo "==> base: Debian 12 of $processor, by ${bootstrap[0]}"
"${bootstrap[@]}" --variant=minbase bookworm "$storage/base" >"$storage/bootstrap.log" 2>&1 ||
  fail "${bootstrap[0]} failed: $(tail -n 3 "$storage/bootstrap.log")"
# As Debian's own slim image.
rm -rf "$storage"/base/usr/share/{doc,man,info,locale,lintian} \
  "$storage"/base/var/{cache/apt/*,lib/apt/lists/*,log/*}
image_of "$storage/base" weft-base$suffix

# What arguments of `buildah build` make; the programs are compiled once.
build() {
  "${buildah[@]}" build --pull-never --arch "$processor" --build-arg BASE=localhost/weft-base$suffix \
    --format docker "$@" . >>"$storage/build.log" 2>&1 ||
    fail "the images do not build: $(tail -n 30 "$storage/build.log")"
}
if [[ $arm64 ]]; then
  echo "==> programs, of $arm64"
  mkdir -p "$storage/programs/licences"
  cp -r LICENSE NOTICE LICENSES/* "$storage/programs/licences"
  for program in weft weftd; do
    aarch64-linux-gnu-strip -o "$storage/programs/$program" "$arm64/$program"
  done
  image_of "$storage/programs" weft-programs$suffix
else
  echo "==> programs, by buildah"
  volumes=()
  cache=$(ccache --get-config cache_dir 2>/dev/null) && mkdir -p "$cache" &&
    volumes=(--volume "$cache:/var/cache/ccache")
  # npm, which makes the console's pages, trusts there whom this machine trusts.
  authorities=/etc/ssl/certs/ca-certificates.crt
  [[ ! -f $authorities ]] ||
    volumes+=(--volume "$authorities:/authorities.crt:ro" --build-arg NODE_EXTRA_CA_CERTS=/authorities.crt)
  build "${volumes[@]}" --target programs --tag weft-programs "$@"
fi
for target in weftd weft; do
  echo "==> image $target$suffix"
  build --build-arg PROGRAMS=localhost/weft-programs$suffix --target $target --tag $target$suffix "$@"
done
