#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# What tests/run.sh leaves out: every test under AddressSanitizer with UndefinedBehaviorSanitizer, and
# every test of threads under ThreadSanitizer; everything compiled by g++, too, with warnings as errors;
# fuzzing; the container; the packages; solvers that take meshes; the documents as they run on other processors;
# packages, image and tests of arm64 under qemu; servers under load and under attack for longer. Prints each step with
# its seconds and fails when any failed.
#
#   tests/deep.sh [STEP...]     STEP: asan tsan gcc fuzz container packages solvers processors arm64 soak;
#                               default: all
#
# WEFT_FUZZ_MINUTES (1 if not set) is how long, about, each target is fuzzed.
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
known=(asan tsan gcc fuzz container packages solvers processors arm64 soak)
for name in "$@"; do
  [[ " ${known[*]} " == *" $name "* ]] || {
    echo "deep.sh: unknown step '$name'; there are ${known[*]}" >&2
    exit 2
  }
done

logs=build/steps/deep
. tests/steps.sh

deep_asan() {
  step "build, sanitizers" build asan --target sanitize-tests &&
    step "tests, sanitizers" run_ctest asan -L sanitize --timeout 900
}

deep_tsan() {
  step "build, threads" build tsan --target threads-tests &&
    step "tests, threads" run_ctest tsan -L threads --timeout 900
}

deep_gcc() {
  step "build, g++" build gcc
}

deep_fuzz() {
  step "build, fuzzers" build asan --target fuzz-targets &&
    step "fuzzers" tests/fuzz/run.sh "${WEFT_FUZZ_MINUTES:-1}"
}

deep_container() {
  if ((EUID != 0)) || ! unshare --mount mount -t tmpfs none /mnt 2>/dev/null; then
    echo "the container: not built, for want of root, or of the right to mount"
    return
  fi
  step "container" tests/container.sh build/release/weft
}

deep_packages() {
  if ((EUID != 0)) || ! unshare --mount mount -t cgroup2 none /mnt 2>/dev/null; then
    echo "the packages: not installed, for want of root, or of the right to mount"
    return
  fi
  step "build, portable" build portable &&
    step "packages" tests/package.sh build/release build/portable
}

deep_solvers() {
  step "install solvers" deploy/install-deps.sh solvers &&
    step "solvers" env PYTHONPATH=build/release/python WEFT_WEFTD="$PWD/build/release/weftd" PATH="$PWD/build/release:$PATH" \
      /usr/bin/python3 -B tests/python/solve.py
}

deep_processors() {
  local processor
  for processor in own avx2 sse4 plain-numpy; do
    step "documents, $processor" \
      /usr/bin/python3 -B tests/documents/documents.py --processor "$processor" build/release
  done
}

# qemu takes 10 to 30 times as long.
deep_arm64() {
  step "install arm64's tools" deploy/install-deps.sh arm64 &&
    step "sysroot, arm64" deploy/arm64/sysroot.sh &&
    step "build, arm64" build release-arm64 --target tests/engine/all tests/checker/all \
      weft weftd weft_c weft_library weft_pages weft_python &&
    step "build, portable, arm64" build portable-arm64 || return
  step "packages, arm64" tests/arm64.sh build/release build/release-arm64 build/portable-arm64
  if ((EUID == 0)) && deploy/arm64/binfmt.sh; then
    step "container, arm64" tests/container.sh build/release/weft build/release-arm64
  else
    echo "the container of arm64: not built, for want of root, or of a kernel that runs programs of arm64 by qemu"
  fi
  local folder
  for folder in engine checker; do
    step "tests, arm64, $folder" ctest --test-dir build/release-arm64/tests/$folder -j "$(nproc)" \
      --no-tests=error --output-on-failure --timeout 7200
  done
}

deep_soak() {
  step "soak" env WEFT_SOAK=1 ctest --preset release -R '^(Soak|HostileMix)' --timeout 3600
}

needed "install packages" deploy/install-deps.sh
needed "install linters" install_linters
needed "build" build release
(($#)) || set -- "${known[@]}"
for name in "$@"; do
  "deep_$name"
done
finish
