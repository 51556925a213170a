// Planes to OpenEXR.
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfIO.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>

#include <cstring>
#include <mutex>
#include <thread>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

/// Blocks of lines are compressed in parallel; any number of threads gives the same bytes.
void use_all_cores() {
  static std::once_flag once;
  std::call_once(once, [] { Imf::setGlobalThreadCount(static_cast<int>(std::thread::hardware_concurrency())); });
}

/// The library swallows write errors of its own streams on closing; a file made in memory is written by us.
class MemoryStream : public Imf::OStream {
 public:
  MemoryStream() : Imf::OStream("memory") {}
  void write(const char bytes[], int count) override {
    const auto end = position_ + static_cast<std::size_t>(count);
    if (bytes_.size() < end) bytes_.resize(end);
    std::memcpy(bytes_.data() + position_, bytes, static_cast<std::size_t>(count));
    position_ = end;
  }
  std::uint64_t tellp() override { return position_; }
  void seekp(std::uint64_t position) override { position_ = position; }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
  std::size_t position_ = 0;
};

template <class T>
Imath::Matrix44<T> to_imath(const glm::dmat4& matrix) {
  Imath::Matrix44<T> result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result[row][column] = static_cast<T>(matrix[row][column]);
  return result;
}

void insert_attributes(Imf::Header& header, const ExrAttributeTable& table) {
  for (const auto& [name, text] : table.texts) header.insert(name, Imf::StringAttribute(text));
  for (const auto& [name, number] : table.numbers) header.insert(name, Imf::DoubleAttribute(number));
  for (const auto& [name, vector] : table.vectors)
    header.insert(name, Imf::V3dAttribute(Imath::V3d(vector.x, vector.y, vector.z)));
  for (const auto& [name, matrix] : table.matrices) {
    if (name == "worldToCamera" || name == "worldToNDC")
      header.insert(name, Imf::M44fAttribute(to_imath<float>(matrix)));
    else
      header.insert(name, Imf::M44dAttribute(to_imath<double>(matrix)));
  }
}

template <class T>
void insert_plane(Imf::Header& header, Imf::FrameBuffer& buffer, const ExrImage& image, const std::string& name,
                  Imf::PixelType type, const std::vector<T>& plane) {
  const auto pixels = static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
  if (plane.size() != pixels)
    throw Error(ErrorKind::unexpected, fmt::format("channel {} has {} samples, the image {} x {} needs {}", name,
                                                   plane.size(), image.width, image.height, pixels));
  header.channels().insert(name, Imf::Channel(type));
  auto* base = const_cast<char*>(reinterpret_cast<const char*>(plane.data()));  // only read while writing
  buffer.insert(name, Imf::Slice(type, base, sizeof(T), sizeof(T) * static_cast<std::size_t>(image.width)));
}

}  // namespace

void write_exr(const std::filesystem::path& path, const ExrImage& image) {
  Imf::Header header(image.width, image.height);
  header.compression() = Imf::ZIP_COMPRESSION;
  header.zipCompressionLevel() = 1;  // half the time of the default for 1 % more bytes on frames of foliage
  insert_attributes(header, image.attributes);
  Imf::FrameBuffer buffer;
  for (const auto& [name, plane] : image.floats) insert_plane(header, buffer, image, name, Imf::FLOAT, plane);
  for (const auto& [name, plane] : image.integers) insert_plane(header, buffer, image, name, Imf::UINT, plane);
  MemoryStream stream;
  try {
    use_all_cores();
    Imf::OutputFile file(stream, header);  // its destructor completes the line table
    file.setFrameBuffer(buffer);
    file.writePixels(image.height);
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::input_output, fmt::format("{}: {}", path.string(), error.what()));
  }
  write_file_atomically(path, stream.bytes());
}

}  // namespace understory
