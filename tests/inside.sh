#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs a command in the folder ROOT as if it were the whole machine, by Debian's programs there. Needs root.
#
#   tests/inside.sh ROOT COMMAND...
set -euo pipefail
# shellcheck disable=SC2016
exec unshare --mount --pid --fork sh -c 'mount -t proc proc "$0/proc" && exec chroot "$0" "$@"' "$1" \
  env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
  DEBIAN_FRONTEND=noninteractive "${@:2}"
