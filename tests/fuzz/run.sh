#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Fuzzes each target with a seed and a count, two at a time, from its corpus; fails if one finds something,
# and says where the input is. What is new of a corpus stays in build/asan/corpus for the next run.
#
#   tests/fuzz/run.sh [MINUTES [TARGET...]]    1 and all targets if not said otherwise
#
# A minute stands for a number of inputs, see below, so a seed repeats a run on any machine. WEFT_FUZZ_SEED
# (1 if not set) is the seed. WEFT_FUZZ_FINDINGS names a folder to collect broken laws in, without ending
# (law.h).
set -uo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.." || exit
minutes=${1:-1}
targets=("${@:2}")
((${#targets[@]})) || targets=(console engine expression formats http manifest store wire)

# About as many inputs as one core runs in a minute.
declare -A inputs=([console]=1500000 [engine]=3000 [expression]=120000 [formats]=100000 [http]=300000 [manifest]=50000
  [store]=20000 [wire]=150000)
# The longest inputs that make sense, in bytes.
declare -A longest=([console]=200 [engine]=160 [expression]=120 [formats]=2500 [http]=300 [manifest]=600 [store]=400 [wire]=400)

fuzz() {
  local target=$1 corpus=build/asan/corpus/$1 found=build/asan/found log=build/asan/$1.log
  mkdir -p "$corpus" "$found"
  # Threads of an arena free what others have allocated, so leaks are looked for at the end alone.
  if build/asan/"$target"_fuzz -detect_leaks=0 -timeout=20 -rss_limit_mb=2500 -entropic=0 \
    -seed="${WEFT_FUZZ_SEED:-1}" -runs="$((minutes * inputs[$target]))" -max_len="${longest[$target]}" -print_final_stats=1 \
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
