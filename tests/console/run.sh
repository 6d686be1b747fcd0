#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Installs what drives the browser, and runs the tests in it. WEFT_PROGRAMS: the folder of weftd and weft.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")"
[[ node_modules/.package-lock.json -nt package-lock.json ]] ||
  npm ci --ignore-scripts --no-audit --no-fund
exec npm test
