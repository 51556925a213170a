// The serial number of an Ogg stream, which VTK draws from the clock: a fixed one makes equal movies equal files.
#pragma once
#include <cstdint>
#include <filesystem>

namespace understory {

/// Rewrites the serial number and the checksum of every page in place (RFC 3533, section 6). Throws Error(input_output)
/// when the file is not a whole sequence of pages up to the one that ends the stream: what a full disk leaves.
void set_ogg_serial_number(const std::filesystem::path& file, std::uint32_t serial);

}  // namespace understory
