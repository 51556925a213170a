#!/usr/bin/env bash
# Compiles every kernel as OpenCL C 1.2 with clang, without a device: once per vector width and per way of building it.
# Any warning fails, double arithmetic by accident included.
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
failures=0

# lint FILE OPTION...
lint() {
  clang-15 -x cl -cl-std=CL1.2 -Xclang -finclude-default-header -fsyntax-only -Wall -Wdouble-promotion -Werror -I. \
    "${@:2}" "$1" || failures=$((failures + 1))
}

for kernel in kernels/*.cl; do
  case $kernel in
    kernels/tile_spheres.cl) widths=16 ;;
    *) widths="1 4 8 16" ;;
  esac
  for width in $widths; do
    for variant in unit_solid_angle unit_solid_angle_exact unit_solid_angle_cosine; do
      lint "$kernel" "-DW=$width" "-DSHARE=$variant"
      grep -q SHARE "$kernel" || break
    done
    if grep -qE 'UNDERSTORY_ATOMIC64|visibility_buffer' "$kernel"; then
      lint "$kernel" "-DW=$width" -DUNDERSTORY_ATOMIC64
    fi
    if grep -q GRASS_HEIGHT "$kernel"; then lint "$kernel" "-DW=$width" -DGRASS_HEIGHT; fi
  done
done
((failures == 0)) || exit 1
echo "kernel lint: every kernel compiles as OpenCL C 1.2 without a warning" >&2
