// A median with its interval in JSON, milliseconds.
#pragma once
#include "bench/timing.hpp"
#include "sim/files/json_fields.hpp"

namespace understory {

inline constexpr JsonFields spread_fields{JsonField{"median", &Spread95::median}, JsonField{"low", &Spread95::low},
                                          JsonField{"high", &Spread95::high}};

}  // namespace understory
