#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 machine to what every change must pass: installs what is missing, checks
# formatting, includes, licences, protocol, scripts and documents, builds with warnings as errors, runs
# every test (the console in a browser is one of them) and, under AddressSanitizer and
# UndefinedBehaviorSanitizer, what reads the bytes of strangers (the corpora of the fuzzers) and what runs
# in parallel; the latter under ThreadSanitizer, too. Prints a table of its steps with their seconds and what the compiler's cache
# gave; fails when any step failed. tests/deep.sh has the rest: what takes an hour, or draws lots.
#
#   tests/run.sh [--quick]     --quick leaves the sanitizers out
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit

case "$#:${1-}" in
  0:) all=yes ;;
  1:--quick) all= ;;
  *)
    echo "usage: tests/run.sh [--quick]" >&2
    exit 2
    ;;
esac

logs=build/steps
. tests/steps.sh

ours() {
  git ls-files --cached --others --exclude-standard -- "$@"
}

check_format() {
  ours '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
}

check_shell() {
  ours '*.sh' .ci/run | xargs shellcheck --severity=warning
}

check_console() (
  cd console || exit
  [[ node_modules/.package-lock.json -nt package-lock.json ]] ||
    npm ci --ignore-scripts --no-audit --no-fund || exit
  npm run check
)

check_protocol() {
  deploy/node_modules/.bin/buf lint proto
}

# By the schemas of what reads them. Debian 12's docker-compose looks for the seccomp profile beside
# whoever calls it, today's beside the file. tests/install/helm_test.py judges the chart.
check_deployment() {
  local folder
  # The image is built from what .dockerignore lets in.
  for folder in $(sed -n 's/^ *add_subdirectory(\([a-z]*\).*/\1/p' CMakeLists.txt); do
    [[ $folder == tests ]] || grep -qxE "!$folder(/.*)?" .dockerignore && continue
    echo ".dockerignore: leaves out $folder/, which CMakeLists.txt adds"
    return 1
  done
  (cd deploy && docker-compose -f compose.yaml config --quiet) || return
  (cd deploy && POSTGRES_PASSWORD=x GRAFANA_PASSWORD=y \
    docker-compose -f compose.cluster.yaml config --quiet) || return
  if (cd deploy && docker-compose -f compose.cluster.yaml config --quiet) 2>/dev/null; then
    echo "deploy/compose.cluster.yaml: starts without passwords"
    return 1
  fi
}

needed "install packages" deploy/install-deps.sh
step "formatting" check_format
step "shell scripts" check_shell
step "includes" tests/includes.py
step "places of tests" tests/mirror.py
step "files that comments name" tests/paths.py
step "limits that texts name" tests/limits.py
needed "install linters" install_linters
step "protocol" check_protocol
step "console" check_console
step "deployment" check_deployment
needed "build" build release
step "licences" tests/licences.sh
step "documents" docs/generate.py build/release --check
step "tests" run_ctest release --timeout 300
if [[ $all ]]; then
  needed "build, sanitizers" build asan --target gate-tests
  step "tests, sanitizers" run_ctest asan -L gate --timeout 600
  needed "build, threads" build tsan --target threads-gate-tests
  step "tests, threads" run_ctest tsan -L 'threads gate' --timeout 600
fi
finish
