// Where gusts come from: a turbulence spectrum with random phases, or a measured record made periodic.
#pragma once
#include <cstdint>
#include <filesystem>

#include "sim/wind.hpp"

namespace understory {

/// Periodic gusts, 1024 s at 32 Hz, with the von Karman spectrum of isotropic turbulence (von Karman 1948, PNAS 34;
/// in this form ESDU 85020 and Burton et al. 2011, "Wind Energy Handbook", eqs. 2.24-2.25) and phases from an integer
/// hash of (seed, component, frequency bin). The deviation of u' is `deviation` exactly, that of v' 0.8 of it, as in
/// the neutral surface layer (Panofsky & Dutton 1984, "Atmospheric Turbulence"). `mean_speed` carries eddies of
/// integral length `length_scale` past a point (Taylor's hypothesis). Zero `mean_speed` or `deviation` gives zeros.
GustSeries synthetic_gusts(double mean_speed, double deviation, double length_scale, std::uint64_t seed);

struct WindRecord {
  double mean_speed = 0;  // length of the mean horizontal vector, m/s
  GustSeries gusts;       // about the mean; along: in its direction
};

/// Reads a CSV with columns `u_ms` and `v_ms` and either `timestamp` (date and time) or `time_s`, equally spaced.
/// The last tenth (or a little more) is cross-faded into the start with equal power; then resampled through its
/// spectrum to a power of two (at most 2^20) samples. Throws Error naming file, line, column and value.
WindRecord read_wind_record(const std::filesystem::path& file);

}  // namespace understory
