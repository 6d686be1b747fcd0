#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Unpacks the arm64 packages of Debian 12 that weft is built of; runs nothing of theirs. dpkg there knows
# them as installed, so that `dpkg-query --admindir` tells which package a file is of.
#
#   deploy/arm64/sysroot.sh [OUT]     OUT is a folder, which is made; default: build/sysroot-arm64, where the
#                                     preset release-arm64 looks. If it is there, nothing is done.
set -euo pipefail
here=$(realpath "$(dirname "${BASH_SOURCE[0]}")")
out=${1:-$here/../../build/sysroot-arm64}
[[ ! -e $out ]] || exit 0

made=$(realpath -m "$out").part
rm -rf "$made"
mkdir -p "$(dirname "$made")"
packages=$("$here/../install-deps.sh" --list libraries geo | paste -sd ,)
mmdebstrap --quiet --variant=extract --architectures=arm64 --skip=cleanup/apt/cache \
  --include="$packages" bookworm "$made"

# What `dpkg --install` would write down.
database=$made/var/lib/dpkg
echo 1 >"$database/info/format"
for deb in "$made"/var/cache/apt/archives/*.deb; do
  name=$(dpkg-deb --field "$deb" Package)
  [[ $(dpkg-deb --field "$deb" Multi-Arch) != same ]] || name+=:arm64
  {
    dpkg-deb --field "$deb"
    echo "Status: install ok installed"
    echo
  } >>"$database/status"
  dpkg-deb --fsys-tarfile "$deb" | tar --list | sed 's|^\.||; s|/$||; s|^$|/.|' >"$database/info/$name.list"
  for kind in symbols shlibs; do
    dpkg-deb --info "$deb" $kind >"$database/info/$name.$kind" 2>/dev/null || rm "$database/info/$name.$kind"
  done
done
rm -rf "$made/var/cache/apt/archives"

# An absolute link would be one into this machine.
while IFS= read -r link; do
  ln -sfrT "$made$(readlink "$link")" "$link"
done < <(find "$made" -type l -lname '/*')
mv -T "$made" "$out"
