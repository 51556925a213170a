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
    kernels/tile_*.cl) widths=16 ;;
    *) widths="1 4 8 16" ;;
  esac
  for width in $widths; do
    if grep -q COMBINE "$kernel"; then
      for rule in multiply simple merge; do lint "$kernel" "-DW=$width" "-DCOMBINE=$rule"; done
      lint "$kernel" "-DW=$width" -DCOMBINE=merge -DPAPER_CONE -DCONES
      lint "$kernel" "-DW=$width" -DCOMBINE=merge -DUNION -DCONES
      continue
    fi
    if grep -q SELF_PAPER "$kernel"; then lint "$kernel" "-DW=$width" -DSELF_PAPER; fi
    for variant in unit_solid_angle unit_solid_angle_exact unit_solid_angle_cosine; do
      lint "$kernel" "-DW=$width" "-DSHARE=$variant"
      grep -q SHARE "$kernel" || break
    done
    if grep -qE 'UNDERSTORY_ATOMIC64|VisibleTriangle' "$kernel"; then
      lint "$kernel" "-DW=$width" -DUNDERSTORY_ATOMIC64
      lint "$kernel" "-DW=$width" -DNARROW_ATOMICS -DRASTER_PASS=1
    fi
    if grep -q QUADRATIC "$kernel"; then
      for radii in 1 2; do lint "$kernel" "-DW=$width" -DNORMALS -DTHICKNESS "-DRADII=$radii"; done
      lint "$kernel" "-DW=$width" -DQUADRATIC -DTHICKNESS
    fi
    for option in BELOW GRASS_HEIGHT SKY_DOME LEVELS THINNED; do
      if grep -q "$option" "$kernel"; then lint "$kernel" "-DW=$width" "-D$option"; fi
    done
  done
done
((failures == 0)) || exit 1
echo "kernel lint: every kernel compiles as OpenCL C 1.2 without a warning" >&2
