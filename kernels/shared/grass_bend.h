// The wind on one blade of grass: when and which gusts reach it, and the bend vector (tip angle times horizontal
// direction, radians) that follows. With d the wind's direction, a = x.d and c = x.(left of d) of the blade's root:
//   delay  = lateral_delay (sin(c/l + 0.3 a/l) + 1/2 sin(1.7 c/l - 0.25 a/l + 1.3)),   l = lateral_scale
//   sample = sample_time - series_rate (slowness a + delay)               gusts travel downwind, their fronts are wavy
//   gust   = cos(p) series[sample] + sin(p) series[sample + count/2],     p = 0.5 c/l
//   wind   = flexibility (mean + gust + flutter), softly limited to 1.5 rad;      bend = rest + wind
// Travelling waves over grass: Finnigan 1979, "Turbulence in waving wheat", Boundary-Layer Meteorology 16. Half a
// period apart the series is independent of itself, so the mix of two keeps its variance and gusts have a finite width.
#ifndef UNDERSTORY_GRASS_BEND_H
#define UNDERSTORY_GRASS_BEND_H

#include "kernels/shared/arc.h"
#include "kernels/shared/records.h"

#ifndef __OPENCL_C_VERSION__
namespace understory {
#endif

/// What a blade looks up: gust = first_share * series[sample] + second_share * series[sample + series_count / 2], where
/// series[s] interpolates linearly between elements floor(s) and floor(s) + 1, both modulo series_count.
typedef struct {
  real sample;  // not reduced modulo series_count
  real first_share, second_share;
} GrassGust;

typedef struct {
  real x, y;  // radians, world axes
} GrassBend;

#define TURNS_PER_RADIAN REAL(0.15915494309189535)

/// `x`, `y`: root relative to the scene's origin, m. In float, `sample` is within 0.1 at 10 km in wind above 1 m/s.
SHARED GrassGust grass_gust(const GrassWind wind, real x, real y) {
  const real dx = (real)(wind.direction_x), dy = (real)(wind.direction_y);
  const real along = fma(x, dx, y * dy), cross = fma(y, dx, -x * dy);
  const real turns = TURNS_PER_RADIAN / (real)(wind.lateral_scale);
  const real a = along * turns, c = cross * turns;
  const real second = sine_of_turns(fma(REAL(1.7), c, fma(REAL(-0.25), a, REAL(0.20690142601946396))));
  const real wave = fma(REAL(0.5), second, sine_of_turns(fma(REAL(0.3), a, c)));
  const real delay = fma((real)(wind.slowness), along, (real)(wind.lateral_delay) * wave);
  GrassGust gust;
  gust.sample = fma(-(real)(wind.series_rate), delay, (real)(wind.sample_time));
  gust.first_share = sine_of_turns(fma(REAL(0.5), c, REAL(0.25)));
  gust.second_share = sine_of_turns(REAL(0.5) * c);
  return gust;
}

/// `gust_along`, `gust_across`: looked up as GrassGust says, radians at flexibility 1. `rest_x`, `rest_y`: bend without
/// wind, radians. `phase`: of the blade's own flutter, radians.
SHARED GrassBend grass_bend(const GrassWind wind, real gust_along, real gust_across, real rest_x, real rest_y,
                            real flexibility, real phase) {
  const real now = (real)(wind.flutter_phase) * TURNS_PER_RADIAN, own = phase * TURNS_PER_RADIAN;
  const real amplitude = (real)(wind.flutter_amplitude);
  const real along = flexibility * fma(amplitude, sine_of_turns(now + own), (real)(wind.mean_bend) + gust_along);
  const real across = flexibility * fma(amplitude, sine_of_turns(fma(REAL(3.0), own, now)), gust_across);
  // Smooth limit b / sqrt(1 + (b / 1.5)^2): slope 1 at rest, a blade in a storm lies down and does not roll up.
  const real limited = REAL(1.0) / sqrt(fma(fma(along, along, across * across), REAL(0.4444444444444444), REAL(1.0)));
  const real dx = (real)(wind.direction_x), dy = (real)(wind.direction_y);
  GrassBend bend;
  bend.x = fma(limited, fma(along, dx, -across * dy), rest_x);
  bend.y = fma(limited, fma(along, dy, across * dx), rest_y);
  return bend;
}

#undef TURNS_PER_RADIAN
#ifndef __OPENCL_C_VERSION__
}  // namespace understory
#endif
#endif
