// Walks the pages of an Ogg file; libogg computes their checksums.
#include "viz/vtk/ogg_serial.hpp"

#include <ogg/ogg.h>

#include <array>
#include <fstream>
#include <numeric>
#include <string>
#include <vector>

#include "sim/error.hpp"

namespace understory {
namespace {

// RFC 3533, section 6: "OggS", version, flags, position (8), serial number (4), sequence (4), checksum (4), segments.
constexpr std::size_t header_bytes = 27, flags_at = 5, serial_at = 14, segments_at = 26;
constexpr unsigned char last_page = 4;

}  // namespace

void set_ogg_serial_number(const std::filesystem::path& path, std::uint32_t serial) {
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  const auto read = [&](std::vector<unsigned char>& bytes, std::size_t count) {
    const std::size_t before = bytes.size();
    bytes.resize(before + count);
    file.read(reinterpret_cast<char*>(bytes.data() + before), static_cast<std::streamsize>(count));
  };
  bool ended = false;
  while (!ended) {
    const std::streampos start = file.tellg();
    std::vector<unsigned char> header, body;
    read(header, header_bytes);
    read(header, header[segments_at]);
    read(body, std::accumulate(header.begin() + header_bytes, header.end(), std::size_t{0}));
    if (!file || std::string(header.begin(), header.begin() + 4) != "OggS")
      throw Error(ErrorKind::input_output,
                  path.string() + ": cannot write the movie: it is cut off (is the disk full?)");
    ended = (header[flags_at] & last_page) != 0;
    for (std::size_t i = 0; i < 4; ++i) header[serial_at + i] = static_cast<unsigned char>(serial >> (8 * i));
    ogg_page page = {header.data(), static_cast<long>(header.size()), body.data(), static_cast<long>(body.size())};
    ogg_page_checksum_set(&page);
    const std::streampos next = file.tellg();
    file.seekp(start);
    file.write(reinterpret_cast<const char*>(header.data()), static_cast<std::streamsize>(header.size()));
    file.seekg(next);
  }
  if (!file.flush()) throw Error(ErrorKind::input_output, path.string() + ": cannot write the movie");
}

}  // namespace understory
