#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# From a fresh Debian 12 machine to all tests run: installs what is missing, builds with warnings as
# errors, runs every test, then those labelled `sanitize` again under AddressSanitizer and
# UndefinedBehaviorSanitizer and those labelled `threads` under ThreadSanitizer, fuzzes, builds and
# runs the container and the packages, and checks formatting, includes, licences, protocol and
# scripts. Prints each step with its seconds, and last the ends of those that failed, what failed in
# ctest, and ctest's closing lines. Fails when any step failed.
#
#   tests/run.sh [--quick]     --quick leaves sanitizers, fuzzers, container and packages out
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

report=() # a line for each step
broken=() # the names of those that failed
logs=build/steps
rm -rf "$logs"
mkdir -p "$logs"

# step NAME COMMAND...
step() {
  local name=$1 start=$EPOCHREALTIME outcome=ok status=0
  shift
  printf '\n==> %s\n' "$name"
  "$@" </dev/null 2>&1 | tee "$logs/$name.log" || { status=$? outcome=FAILED broken+=("$name"); }
  report+=("$(awk -v a="$start" -v b="$EPOCHREALTIME" -v name="$name" -v outcome="$outcome" \
    'BEGIN { printf "%-34s %7.1f s  %s", name, b - a, outcome }')")
  echo "==> ${report[-1]}"
  return $status
}

# needed NAME COMMAND...: a step without which the rest makes no sense
needed() {
  step "$@" || finish
}

finish() {
  printf '\n--- steps ---\n'
  printf '%s\n' "${report[@]}"
  local name log
  for name in "${broken[@]}"; do
    printf '\n--- %s, which failed ---\n' "$name"
    grep -A 8 ': Failure$' "$logs/$name.log" | head -n 60
    tail -n 60 "$logs/$name.log"
  done
  # What failed in the browser once, too.
  sed -n '/failing tests:$/,/^> test$/p' "$logs/console in a browser.log" 2>/dev/null | head -n 60
  for log in "$logs"/tests*.log; do
    [[ -e $log ]] || continue
    printf '\n--- %s ---\n' "$(basename "$log" .log)"
    sed -n '/% tests passed/,$p' "$log"
  done
  ((${#broken[@]} == 0))
  exit
}

# run_ctest PRESET ARGUMENT...
run_ctest() {
  local preset=$1
  shift
  ctest --preset "$preset" -j "$(nproc)" --no-tests=error --no-label-summary "$@"
}

ours() {
  git ls-files --cached --others --exclude-standard -- "$@"
}

check_format() {
  ours '*.h' '*.cpp' | xargs clang-format --dry-run -Werror
}

check_shell() {
  ours '*.sh' .ci/run | xargs shellcheck --severity=warning
}

install_linters() (
  cd deploy || exit
  [[ node_modules/.package-lock.json -nt package-lock.json ]] ||
    npm ci --ignore-scripts --no-audit --no-fund
)

check_console() (
  cd console || exit
  [[ node_modules/.package-lock.json -nt package-lock.json ]] ||
    npm ci --ignore-scripts --no-audit --no-fund || exit
  npm run check
)

check_console_in_browser() (
  cd tests/console || exit
  [[ node_modules/.package-lock.json -nt package-lock.json ]] ||
    npm ci --ignore-scripts --no-audit --no-fund || exit
  timeout 1800 npm test && exit
  echo "A browser's test failed. All run once more: what fails again fails this step."
  timeout 1800 npm test
)

check_protocol() {
  deploy/node_modules/.bin/buf lint proto
}

# By the schemas of what reads them. Debian 12's docker-compose looks for the seccomp profile beside
# whoever calls it, today's beside the file. Debian 12 has no kustomize that knows resources in other
# folders; what kubectl has since 1.21 does.
check_deployment() {
  local overlay
  (cd deploy && docker-compose -f compose.yaml config --quiet) || return
  (cd deploy && POSTGRES_PASSWORD=x GRAFANA_PASSWORD=y \
    docker-compose -f compose.cluster.yaml config --quiet) || return
  if (cd deploy && docker-compose -f compose.cluster.yaml config --quiet) 2>/dev/null; then
    echo "deploy/compose.cluster.yaml: starts without passwords"
    return 1
  fi
  if ! grep -q '^Kustomize Version: v[4-9]' <<<"$(kubectl version --client 2>/dev/null)"; then
    echo "deploy/kubernetes: not checked, for want of kubectl 1.21 or later"
    return
  fi
  for overlay in deploy/kubernetes/overlays/*; do
    kubectl kustomize "$overlay" | node deploy/check-kubernetes.mjs || return
  done
}

check_container() {
  if ((EUID != 0)) || ! unshare --mount mount -t tmpfs none /mnt 2>/dev/null; then
    echo "the container: not built, for want of root, or of the right to mount"
    return
  fi
  tests/container.sh build/release/weft
}

check_packages() {
  if ((EUID != 0)) || ! unshare --mount mount -t cgroup2 none /mnt 2>/dev/null; then
    echo "the packages: not installed, for want of root, or of the right to mount"
    return
  fi
  cmake --preset portable -DWEFT_WERROR=ON && cmake --build --preset portable &&
    tests/package.sh build/release build/portable
}

export UBSAN_OPTIONS=print_stacktrace=1
export TSAN_OPTIONS=suppressions=$PWD/tests/tsan.supp
export LSAN_OPTIONS=suppressions=$PWD/tests/lsan.supp:print_suppressions=0

needed "install packages" deploy/install-deps.sh
step "formatting" check_format
step "shell scripts" check_shell
step "includes" tests/includes.py
step "places of tests" tests/mirror.py
needed "install linters" install_linters
step "protocol" check_protocol
step "console" check_console
step "deployment" check_deployment
needed "configure" cmake --preset release -DWEFT_WERROR=ON
needed "build" cmake --build --preset release
step "licences" tests/licences.sh
step "documents" docs/generate.py build/release --check
step "tests" run_ctest release --timeout 300
step "console in a browser" check_console_in_browser
if [[ $all ]]; then
  step "container" check_container
  step "packages" check_packages
  needed "configure, sanitizers" cmake --preset asan -DWEFT_WERROR=ON
  needed "build, sanitizers" cmake --build --preset asan --target sanitize-tests
  step "tests, sanitizers" run_ctest asan -L sanitize --timeout 600
  needed "configure, threads" cmake --preset tsan -DWEFT_WERROR=ON
  needed "build, threads" cmake --build --preset tsan --target threads-tests
  step "tests, threads" run_ctest tsan -L threads --timeout 600
  needed "configure, fuzzers" cmake --preset fuzz -DWEFT_WERROR=ON
  needed "build, fuzzers" cmake --build --preset fuzz --target fuzz-targets
  step "fuzzers" tests/fuzz/run.sh 20
fi
finish
