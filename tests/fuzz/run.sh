#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes each target for a while, two at a time, from its corpus; fails if one finds something, and
# says where the input is. What is new of a corpus stays in build/fuzz/corpus for the next run.
#
#   tests/fuzz/run.sh [SECONDS [TARGET...]]    20 seconds and all targets if not said otherwise
#
# WEFT_FUZZ_SEED (1 if not set) is the seed. It is fixed so that two runs on one tree draw the same
# inputs, as far as their time goes; runs of hours take others.
# WEFT_FUZZ_FINDINGS names a folder to collect broken laws in, without ending (law.h).
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
seconds=${1:-20}
targets=("${@:2}")
((${#targets[@]})) || targets=(console engine expression formats manifest store wire)

# The longest inputs that make sense, in bytes.
declare -A longest=([console]=200 [engine]=160 [expression]=120 [formats]=2500 [manifest]=600 [store]=400 [wire]=400)

fuzz() {
  local target=$1 corpus=build/fuzz/corpus/$1 found=build/fuzz/found log=build/fuzz/$1.log
  mkdir -p "$corpus" "$found"
  # Threads of an arena free what others have allocated, so leaks are looked for at the end alone.
  if build/fuzz/"$target"_fuzz -detect_leaks=0 -timeout=20 -rss_limit_mb=2500 -entropic=0 \
    -seed="${WEFT_FUZZ_SEED:-1}" -max_total_time="$seconds" -max_len="${longest[$target]}" -print_final_stats=1 \
    -artifact_prefix="$found/$target-" "$corpus" tests/fuzz/corpus/"$target" >"$log" 2>&1; then
    printf '%-11s %8s inputs, %s\n' "$target" \
      "$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")" \
      "$(sed -n 's/.*DONE *cov: \([0-9]*\) ft: \([0-9]*\).*/\1 edges, \2 features/p' "$log")"
  else
    printf '%s: a finding, see %s\n' "$target" "$log"
    grep -m 1 -A 30 'broken law\|ERROR: \|runtime error' "$log"
    grep 'Test unit written' "$log"
    return 1
  fi
}

failed=0
running=0
for target in "${targets[@]}"; do
  fuzz "$target" &
  ((++running < 2)) || { wait -n || failed=1; ((--running)); }
done
while ((running-- > 0)); do wait -n || failed=1; done
exit $failed
