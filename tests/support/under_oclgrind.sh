#!/usr/bin/env bash
# under_oclgrind.sh TEST_PROGRAM FILTER: runs the chosen tests on oclgrind's simulated device, which watches every access
# to memory, every data race and every OpenCL call. Fails on the first report. -O0: oclgrind knows no later intrinsics.
set -euo pipefail
log=$(mktemp)
trap 'rm -f "$log"' EXIT
oclgrind --data-races --check-api --build-options -O0 --log "$log" "$1" --gtest_filter="$2" --gtest_brief=1
if [[ -s $log ]]; then
  cat "$log" >&2
  exit 1
fi
