// OpenEXR to planes.
#include <ImfChannelList.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputPart.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfMultiPartInputFile.h>
#include <ImfPartType.h>
#include <ImfStringAttribute.h>
#include <ImfVecAttribute.h>
#include <fmt/format.h>

#include <algorithm>

#include "sim/error.hpp"
#include "viz/exr/image.hpp"

namespace understory {
namespace {

constexpr std::int64_t largest_pixel_count = std::int64_t{1} << 28;  // 16384 x 16384, the largest image of a scene
constexpr std::size_t largest_channel_count = 1024;

template <class T>
glm::dmat4 from_imath(const Imath::Matrix44<T>& matrix) {
  glm::dmat4 result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column) result[row][column] = static_cast<double>(matrix[row][column]);
  return result;
}

ExrAttributeTable extract_attributes(const Imf::Header& header) {
  ExrAttributeTable table;
  for (auto at = header.begin(); at != header.end(); ++at) {
    const std::string name = at.name();
    const Imf::Attribute* value = &at.attribute();
    if (auto* text = dynamic_cast<const Imf::StringAttribute*>(value)) table.texts[name] = text->value();
    if (auto* number = dynamic_cast<const Imf::DoubleAttribute*>(value)) table.numbers[name] = number->value();
    if (auto* number = dynamic_cast<const Imf::FloatAttribute*>(value)) table.numbers[name] = number->value();
    if (auto* number = dynamic_cast<const Imf::IntAttribute*>(value)) table.numbers[name] = number->value();
    if (auto* vector = dynamic_cast<const Imf::V3dAttribute*>(value))
      table.vectors[name] = {vector->value().x, vector->value().y, vector->value().z};
    if (auto* matrix = dynamic_cast<const Imf::M44fAttribute*>(value))
      table.matrices[name] = from_imath(matrix->value());
    if (auto* matrix = dynamic_cast<const Imf::M44dAttribute*>(value))
      table.matrices[name] = from_imath(matrix->value());
  }
  return table;
}

ExrSample sample_of(Imf::PixelType type) {
  if (type == Imf::HALF) return ExrSample::half_float;
  return type == Imf::UINT ? ExrSample::uint32 : ExrSample::float32;
}

/// Runs `read`; what the library throws becomes our error with the file's name.
template <class Read>
auto with_file_name(const std::filesystem::path& path, Read read) {
  if (!std::filesystem::exists(path)) throw Error(ErrorKind::invalid_input, path.string() + ": no such file");
  try {
    return read();
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: not a readable EXR image: {}", path.string(), error.what()));
  }
}

void check_part(const std::filesystem::path& path, const Imf::MultiPartInputFile& file, int part) {
  const auto refuse = [&](const std::string& why) {
    throw Error(ErrorKind::invalid_input, fmt::format("{}: {}", path.string(), why));
  };
  const Imf::Header& header = file.header(part);
  if (header.hasType() && header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE)
    refuse("deep images are not read; flatten it first");
  if (!file.partComplete(part)) refuse("the file is cut off: not every line of pixels is there");
  for (const Imath::Box2i& window : {header.displayWindow(), header.dataWindow()}) {
    const auto width = std::int64_t{window.max.x} - window.min.x + 1;
    const auto height = std::int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1 || width > largest_pixel_count || height > largest_pixel_count ||
        width * height > largest_pixel_count)
      refuse(fmt::format("image of {} x {} pixels; at most {} pixels are read", width, height, largest_pixel_count));
  }
  if (header.displayWindow() != file.header(0).displayWindow()) refuse("its parts differ in size");
  for (auto at = header.channels().begin(); at != header.channels().end(); ++at)
    if (at.channel().xSampling != 1 || at.channel().ySampling != 1)
      refuse(fmt::format("channel {} is subsampled; only full resolution is read", at.name()));
}

/// Copies the part of the data window that lies in the display window.
template <class T>
std::vector<T> crop(const std::vector<T>& data, const Imath::Box2i& window, const Imath::Box2i& display) {
  const int width = display.max.x - display.min.x + 1, height = display.max.y - display.min.y + 1;
  const auto stride = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  std::vector<T> plane(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), T(0));
  const int first = std::max(window.min.x, display.min.x), last = std::min(window.max.x, display.max.x);
  for (int y = std::max(window.min.y, display.min.y); y <= std::min(window.max.y, display.max.y) && first <= last;
       ++y) {
    const T* source = data.data() + stride * static_cast<std::size_t>(y - window.min.y) + (first - window.min.x);
    std::copy(source, source + (last - first + 1),
              plane.begin() + std::ptrdiff_t{y - display.min.y} * width + (first - display.min.x));
  }
  return plane;
}

template <class T>
std::vector<std::vector<T>> read_planes(const std::filesystem::path& path, const ExrHeader& header,
                                        std::span<const std::string> names, Imf::PixelType type) {
  return with_file_name(path, [&] {
    Imf::MultiPartInputFile file(path.c_str());
    std::vector<std::vector<T>> planes(names.size());
    for (int part = 0; part < file.parts(); ++part) {
      check_part(path, file, part);
      const Imath::Box2i window = file.header(part).dataWindow();
      Imf::FrameBuffer buffer;
      bool wanted = false;
      for (std::size_t i = 0; i < names.size(); ++i) {
        const ExrChannel* channel = header.find(names[i]);
        if (channel == nullptr)
          throw Error(ErrorKind::invalid_input, fmt::format("{}: no channel {}", path.string(), names[i]));
        if (channel->part != part) continue;
        wanted = true;
        const auto stride = static_cast<std::size_t>(window.max.x - window.min.x + 1);
        planes[i].resize(stride * static_cast<std::size_t>(window.max.y - window.min.y + 1));
        buffer.insert(channel->name_in_part,
                      Imf::Slice::Make(type, planes[i].data(), window, sizeof(T), sizeof(T) * stride));
      }
      if (!wanted) continue;
      Imf::InputPart input(file, part);
      input.setFrameBuffer(buffer);
      input.readPixels(window.min.y, window.max.y);
      for (std::size_t i = 0; i < names.size(); ++i)
        if (header.find(names[i])->part == part && window != file.header(0).displayWindow())
          planes[i] = crop(planes[i], window, file.header(0).displayWindow());
    }
    return planes;
  });
}

}  // namespace

const ExrChannel* ExrHeader::find(const std::string& name) const {
  const auto at = std::find_if(channels.begin(), channels.end(), [&](const auto& c) { return c.name == name; });
  return at == channels.end() ? nullptr : &*at;
}

ExrHeader read_exr_header(const std::filesystem::path& path) {
  return with_file_name(path, [&] {
    Imf::MultiPartInputFile file(path.c_str());
    ExrHeader result;
    for (int part = 0; part < file.parts(); ++part) {
      check_part(path, file, part);
      const Imf::Header& header = file.header(part);
      result.data_window_differs |= header.dataWindow() != header.displayWindow();
      const std::string prefix = file.parts() > 1 ? header.name() + ":" : "";
      for (auto at = header.channels().begin(); at != header.channels().end(); ++at)
        result.channels.push_back({prefix + at.name(), part, at.name(), sample_of(at.channel().type)});
    }
    if (result.channels.empty() || result.channels.size() > largest_channel_count)
      throw Error(ErrorKind::invalid_input, fmt::format("{}: {} channels; 1 to {} are read", path.string(),
                                                        result.channels.size(), largest_channel_count));
    const Imath::Box2i display = file.header(0).displayWindow();
    result.width = display.max.x - display.min.x + 1;
    result.height = display.max.y - display.min.y + 1;
    result.attributes = extract_attributes(file.header(0));
    return result;
  });
}

std::vector<Plane> read_exr_floats(const std::filesystem::path& path, const ExrHeader& header,
                                   std::span<const std::string> names) {
  return read_planes<float>(path, header, names, Imf::FLOAT);
}

std::vector<std::vector<std::uint32_t>> read_exr_integers(const std::filesystem::path& path, const ExrHeader& header,
                                                          std::span<const std::string> names) {
  return read_planes<std::uint32_t>(path, header, names, Imf::UINT);
}

ExrImage read_exr(const std::filesystem::path& path) {
  const ExrHeader header = read_exr_header(path);
  ExrImage image{header.width, header.height, {}, {}, header.attributes};
  std::vector<std::string> floats, integers;
  for (const ExrChannel& channel : header.channels)
    (channel.sample == ExrSample::uint32 ? integers : floats).push_back(channel.name);
  auto float_planes = read_exr_floats(path, header, floats);
  for (std::size_t i = 0; i < floats.size(); ++i) image.floats[floats[i]] = std::move(float_planes[i]);
  auto integer_planes = read_exr_integers(path, header, integers);
  for (std::size_t i = 0; i < integers.size(); ++i) image.integers[integers[i]] = std::move(integer_planes[i]);
  return image;
}

}  // namespace understory
