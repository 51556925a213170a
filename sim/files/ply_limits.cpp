// Checks PLY files against their own header before assimp reads them (format: Greg Turk, "The PLY Polygon File
// Format").
#include "sim/files/ply_limits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "sim/error.hpp"
#include "sim/files/mesh.hpp"
#include "sim/files/text.hpp"

namespace understory {
namespace {

constexpr std::size_t longest_header = 65536;
constexpr std::int64_t most_corners = 255;  // of one face

struct Type {
  const char* names[2];
  std::size_t bytes;
  bool is_real, is_signed;
};
constexpr Type types[] = {{{"char", "int8"}, 1, false, true},    {{"uchar", "uint8"}, 1, false, false},
                          {{"short", "int16"}, 2, false, true},  {{"ushort", "uint16"}, 2, false, false},
                          {{"int", "int32"}, 4, false, true},    {{"uint", "uint32"}, 4, false, false},
                          {{"float", "float32"}, 4, true, true}, {{"double", "float64"}, 8, true, true}};

struct Property {
  std::string name;
  const Type* count = nullptr;  // lists only
  const Type* value = nullptr;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

class PlyChecker {
 public:
  explicit PlyChecker(const std::filesystem::path& file) : file_(file.string()) {
    std::ifstream stream(file, std::ios::binary);
    text_.resize(std::filesystem::file_size(file));
    if (!stream.read(text_.data(), static_cast<std::streamsize>(text_.size()))) {
      throw Error(ErrorKind::input_output, file_ + ": cannot be read");
    }
  }

  void check() {
    read_header();
    for (const Element& element : elements_) {
      if (element.name == "vertex") vertices_ = element.count;
      if (element.count > std::min(largest_mesh_vertices, largest_mesh_triangles)) {
        refuse(fmt::format("{} x '{}': at most {} are allowed", element.count, element.name, largest_mesh_vertices));
      }
      // Also keeps the loop below no longer than the file, whatever the count says.
      if (element.properties.empty() || element.count > text_.size() - at_) refuse_short(element);
      for (std::uint64_t i = 0; i < element.count; ++i) walk(element, i);
    }
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::invalid_input, file_ + ": not a usable PLY file: " + what);
  }
  [[noreturn]] void refuse_short(const Element& element) const {
    refuse(fmt::format("it announces {} x '{}' and is too short for them", element.count, element.name));
  }

  std::string header_line() {
    const std::size_t end = text_.find('\n', at_);
    if (end == std::string::npos || end > longest_header) refuse("its header has no end");
    std::string line = text_.substr(at_, end - at_);
    if (!line.empty() && line.back() == '\r') line.pop_back();
    at_ = end + 1;
    const bool printable =
        std::all_of(line.begin(), line.end(), [](unsigned char c) { return c >= 0x20 || c == '\t'; });
    if (!printable) refuse("its header is not text");
    return line;
  }

  void read_header() {
    if (header_line() != "ply") refuse("it does not begin with 'ply'");
    for (std::string line = header_line(); line != "end_header"; line = header_line()) {
      std::istringstream words(line);
      std::string word;
      words >> word;
      if (word == "format") {
        read_format(words, line);
      } else if (word == "element") {
        Element element;
        if (!(words >> element.name >> element.count)) refuse_line(line);
        elements_.push_back(element);
      } else if (word == "property") {
        read_property(words, line);
      } else if (word != "comment" && word != "obj_info") {
        refuse_line(line);
      }
    }
    if (!has_format_) refuse("its header names no format");
    const auto is_vertex = [](const Element& element) { return element.name == "vertex"; };
    if (std::count_if(elements_.begin(), elements_.end(), is_vertex) != 1) refuse("it has no element 'vertex'");
  }

  [[noreturn]] void refuse_line(const std::string& line) const { refuse("header line '" + readable(line) + "'"); }

  void read_format(std::istringstream& words, const std::string& line) {
    std::string format, version;
    words >> format >> version;
    is_text_ = format == "ascii";
    is_big_endian_ = format == "binary_big_endian";
    if ((!is_text_ && !is_big_endian_ && format != "binary_little_endian") || version != "1.0") refuse_line(line);
    has_format_ = true;
  }

  void read_property(std::istringstream& words, const std::string& line) {
    Property property;
    std::string type;
    words >> type;
    if (type == "list") {
      words >> type;
      property.count = find_type(type, line);
      if (property.count->is_real) refuse_line(line);
      words >> type;
    }
    property.value = find_type(type, line);
    if (!(words >> property.name) || elements_.empty()) refuse_line(line);
    elements_.back().properties.push_back(property);
  }

  const Type* find_type(const std::string& name, const std::string& line) const {
    for (const Type& type : types) {
      if (name == type.names[0] || name == type.names[1]) return &type;
    }
    refuse_line(line);
  }

  /// One vertex, face or whatever the element is.
  void walk(const Element& element, std::uint64_t index) {
    for (const Property& property : element.properties) {
      if (!property.count) {
        skip(element, *property.value);
        continue;
      }
      const bool is_face = property.name == "vertex_indices" || property.name == "vertex_index";
      const std::int64_t count = read(element, *property.count);
      if (count < (is_face ? 3 : 0) || count > most_corners) {
        refuse(fmt::format("'{}' {} has a list of {}: allowed are {} to {}", element.name, index, count,
                           is_face ? 3 : 0, most_corners));
      }
      for (std::int64_t i = 0; i < count; ++i) {
        if (!is_face || property.value->is_real) {
          skip(element, *property.value);
          continue;
        }
        const std::int64_t vertex = read(element, *property.value);
        if (vertex < 0 || static_cast<std::uint64_t>(vertex) >= vertices_) {
          refuse(fmt::format("'{}' {} names vertex {} of {}", element.name, index, vertex, vertices_));
        }
      }
    }
    if (is_text_) end_line(element);
  }

  std::string_view word(const Element& element) {
    at_ = std::min(text_.find_first_not_of(" \t", at_), text_.size());
    const std::size_t end = std::min(text_.find_first_of(" \t\r\n", at_), text_.size());
    if (end == at_) refuse_short(element);
    const std::string_view found = std::string_view(text_).substr(at_, end - at_);
    at_ = end;
    return found;
  }

  void end_line(const Element& element) {
    at_ = std::min(text_.find_first_not_of(" \t\r", at_), text_.size());
    if (at_ < text_.size() && text_[at_] != '\n') refuse(fmt::format("a line of '{}' is too long", element.name));
    at_ = std::min(at_ + 1, text_.size());
  }

  void skip(const Element& element, const Type& type) {
    if (is_text_) {
      word(element);
    } else if (type.bytes > text_.size() - at_) {
      refuse_short(element);
    } else {
      at_ += type.bytes;
    }
  }

  std::int64_t read(const Element& element, const Type& type) {
    std::int64_t value = 0;
    if (is_text_) {
      const std::string_view digits = word(element);
      const auto [stop, failure] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
      if (failure != std::errc() || stop != digits.data() + digits.size())
        refuse("'" + readable(digits) + "' is no whole number");
      return value;
    }
    const std::size_t start = at_;
    skip(element, type);
    std::uint64_t bits = 0;
    for (std::size_t i = 0; i < type.bytes; ++i) {
      const std::size_t byte = is_big_endian_ ? i : type.bytes - 1 - i;
      bits = bits << 8 | static_cast<unsigned char>(text_[start + byte]);
    }
    const std::size_t unused = 64 - 8 * type.bytes;
    return type.is_signed ? static_cast<std::int64_t>(bits << unused) >> unused : static_cast<std::int64_t>(bits);
  }

  std::string file_, text_;
  std::size_t at_ = 0;
  std::vector<Element> elements_;
  std::uint64_t vertices_ = 0;
  bool has_format_ = false, is_text_ = false, is_big_endian_ = false;
};

}  // namespace

void check_ply(const std::filesystem::path& file) { PlyChecker(file).check(); }

}  // namespace understory
