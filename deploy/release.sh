#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Makes everything that is released, from a clone of the commit that is checked out:
#
#   deploy/release.sh OUT      OUT is a folder, which is made and must be empty
#
# packages for Debian, the package for Python with and without programs and as sources, the images as OCI archives,
# the Helm chart, a software bill of materials (CycloneDX), the changelog, and SHA256SUMS of them. Packages, wheel,
# bill and images are for arm64, too, if `deploy/install-deps.sh arm64` has installed what that takes: an archive then
# has the images of both processors. The version is that of CMakeLists.txt; the maintainer of the packages for Debian is
# WEFT_MAINTAINER, if that is set. Needs what deploy/install-deps.sh installs, and root for the images:
# without root, or buildah or debootstrap, it says that they are left out, and so it does with those for arm64 if the
# kernel does not run its programs by qemu.
#
# Fails if the tree has changes that are not committed, because the clone would not have them. The same
# commit on a machine with the same packages gives the same bytes, except for the images, into which apt
# installs what Debian has today.
set -euo pipefail
out=${1:?usage: deploy/release.sh OUT}
tree=$(realpath "$(dirname "${BASH_SOURCE[0]}")/..")

say() { printf '==> %s (at %d s)\n' "$*" $SECONDS; }
fail() {
  printf 'release.sh: %s\n' "$*" >&2
  exit 1
}

changes=$(git -C "$tree" status --porcelain)
[[ -z $changes ]] || fail $'the tree has changes that are not committed:\n'"$changes"
mkdir -p "$out"
out=$(realpath "$out")
[[ -z $(ls -A "$out") ]] || fail "$out is not empty"

scratch=$(mktemp -d)
# buildah leaves the file systems of the images' layers mounted.
tidy_up() {
  awk -v inside="$scratch/" 'index($2, inside) == 1 { print $2 }' /proc/mounts | sort -r |
    xargs --no-run-if-empty umount
  rm -rf --one-file-system "$scratch"
}
trap tidy_up EXIT
clone=$scratch/weft
git clone --quiet "$tree" "$clone"
cd "$clone"
SOURCE_DATE_EPOCH=$(git log -1 --format=%ct)
export SOURCE_DATE_EPOCH

say "build of $(git rev-parse HEAD)"
build() { # as tests/run.sh does, whose cache then serves
  cmake --preset "$1" -DBUILD_TESTING=OFF -DWEFT_WERROR=ON \
    ${WEFT_MAINTAINER:+"-DWEFT_MAINTAINER=$WEFT_MAINTAINER"} &&
    cmake --build --preset "$1"
}
for preset in release portable; do
  build $preset >"$scratch/build.log" 2>&1 ||
    fail "the preset $preset does not build: $(tail -n 30 "$scratch/build.log")"
done
version=$(build/release/weftd --version | cut -d ' ' -f 2)

say "packages for Debian"
cpack --config build/release/CPackConfig.cmake -B "$scratch/packages" >"$scratch/cpack.log" 2>&1 ||
  fail "cpack failed: $(tail "$scratch/cpack.log")"
mv "$scratch"/packages/*.deb "$out"

say "packages for Python"
/usr/bin/python3 -B deploy/package/wheels.py build/portable "$out"

arm64=
tools=(mmdebstrap ld.lld qemu-aarch64-static aarch64-linux-gnu-strip)
if (($(command -v "${tools[@]}" | wc -l) == ${#tools[@]})); then
  say "packages for arm64"
  arm64=build/release-arm64
  deploy/arm64/sysroot.sh
  for preset in release-arm64 portable-arm64; do
    build $preset >"$scratch/build.log" 2>&1 ||
      fail "the preset $preset does not build: $(tail -n 30 "$scratch/build.log")"
  done
  deploy/arm64/packages.sh $arm64 "$scratch/arm64" >"$scratch/cpack.log" 2>&1 ||
    fail "cpack failed: $(tail "$scratch/cpack.log")"
  mv "$scratch"/arm64/*_arm64.deb "$out"
  /usr/bin/python3 -B deploy/package/wheels.py build/portable-arm64 "$out"
else
  echo "arm64 is left out, for want of what deploy/install-deps.sh arm64 installs"
fi

say "bill of materials"
(cd deploy && npm ci --silent --ignore-scripts --no-audit --no-fund)
for built in build/release $arm64; do
  bill=$out/weft-$version${built#build/release}.cdx.json
  /usr/bin/python3 -B deploy/package/bill_of_materials.py $built "$bill"
  node deploy/check-bill.mjs "$bill"
done

say "chart"
tar --create --sort=name --mtime="@$SOURCE_DATE_EPOCH" --owner=0 --group=0 --numeric-owner --mode=u=rwX,go=rX \
  --directory deploy/helm weft | gzip --no-name >"$out/weft-$version.tgz"
/usr/bin/python3 -B -m pytest -q -p no:cacheprovider tests/install/helm_test.py

cp CHANGELOG.md "$out"

if ((EUID == 0)) && command -v buildah >/dev/null && command -v debootstrap >/dev/null; then
  say "images"
  deploy/image.sh "$scratch/image"
  suffixes=('')
  if [[ $arm64 ]] && deploy/arm64/binfmt.sh; then
    deploy/image.sh --arm64 $arm64 "$scratch/image"
    suffixes+=(-arm64)
  else
    echo "the images for arm64 are left out, for want of its packages, or of a kernel that runs its programs by qemu"
  fi
  export STORAGE_DRIVER=vfs
  buildah=(buildah --root "$scratch/image/images" --runroot "$scratch/image/run")
  for name in weftd weft; do
    "${buildah[@]}" manifest create "$name:$version" "${suffixes[@]/#/localhost/$name}"
    "${buildah[@]}" manifest push --quiet --all "$name:$version" "oci-archive:$out/$name-$version-image.tar:$name:$version"
  done
else
  echo "the images are left out, for want of root, buildah or debootstrap"
fi

(cd "$out" && sha256sum -- * >"$scratch/sums" && mv "$scratch/sums" SHA256SUMS)
say "weft $version is in $out"
(cd "$out" && du --apparent-size --block-size=1000 -- *)
