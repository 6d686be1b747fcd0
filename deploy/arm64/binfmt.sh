#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Has the kernel run programs of arm64 by qemu, in other roots, too, until the machine starts again. Where
# systemd runs, Debian's qemu-user-static has done so. Needs root and what `deploy/install-deps.sh arm64`
# installs; fails if the kernel does not take it.
set -euo pipefail
[[ $(uname -m) != aarch64 ]] || exit 0
handlers=/proc/sys/fs/binfmt_misc
[[ -e $handlers/register ]] || mount -t binfmt_misc binfmt_misc $handlers
[[ -e $handlers/qemu-aarch64 ]] || cat /usr/lib/binfmt.d/qemu-aarch64.conf >$handlers/register
grep -q '^flags:.*F' $handlers/qemu-aarch64
