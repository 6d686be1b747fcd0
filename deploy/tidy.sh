#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Runs clang-tidy, as .clang-tidy says, over the compiled sources under the given folders.
#
#   deploy/tidy.sh [FOLDER...]     default: engine server files client checker
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

# Each source by itself. Generated headers must exist before anything that includes them can be read.
cmake --preset release -B build/tidy -DWEFT_UNITY=OFF
cmake --build build/tidy --target weft_proto

folders=("${@:-engine}")
(($#)) || folders+=(server files client checker)
exec run-clang-tidy -quiet -p build/tidy "${folders[@]/#/^$PWD/}"
