#!/usr/bin/env bash
# under_oclgrind.sh TEST_PROGRAM FILTER [races-allowed]: runs the chosen tests on oclgrind's simulated device, which
# watches every access to memory, every data race and every OpenCL call. Fails on the first report. Kernels that draw
# look at a pixel before they ask for it by an atomic: that race is meant. -O0: oclgrind knows no later intrinsics.
set -euo pipefail
log=$(mktemp)
trap 'rm -f "$log"' EXIT
races=(--data-races)
if [[ ${3:-} == races-allowed ]]; then races=(); fi
# Not --log: every context would begin that file anew.
oclgrind "${races[@]}" --check-api --build-options -O0 "$1" --gtest_filter="$2" --gtest_brief=1 2>"$log" || {
  cat "$log" >&2
  exit 1
}
if [[ -s $log ]]; then
  cat "$log" >&2
  exit 1
fi
