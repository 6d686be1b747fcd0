#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy, as .clang-tidy says, over the compiled sources under the given folders.
#
#   deploy/tidy.sh [FOLDER...]     default: engine server client checker
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

[[ -f build/release/compile_commands.json ]] || cmake --preset release
# Generated headers must exist before anything that includes them can be read.
cmake --build --preset release --target weft_proto

folders=("${@:-engine}")
(($#)) || folders+=(server client checker)
exec run-clang-tidy -quiet -p build/release "${folders[@]/#/^$PWD/}"
