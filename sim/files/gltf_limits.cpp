// Checks the structure of glTF files before assimp reads them: glTF 2.0 specification, sections 3.5 to 3.7 and 4.
#include "sim/files/gltf_limits.hpp"

#include <fmt/format.h>

#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "sim/error.hpp"
#include "sim/files/mesh.hpp"

namespace understory {
namespace {

using Json = nlohmann::json;
constexpr std::uint64_t most_nodes = 100'000;
constexpr int deepest_node = 256;

/// The parsed JSON with checked access; every message carries the file's name.
class GltfChecker {
 public:
  explicit GltfChecker(const std::filesystem::path& file) : file_(file.string()) { load(file); }

  void check() {
    if (!json_.is_object()) refuse("the JSON is not an object");
    check_buffers();
    for (const Json& accessor : array("accessors")) check_accessor(accessor);
    check_size();
    check_nodes();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::invalid_input, file_ + ": not a usable glTF file: " + what);
  }

  void load(const std::filesystem::path& path) {
    std::ifstream stream(path, std::ios::binary);
    std::uint32_t header[5] = {};  // magic, version, length; first chunk: length, type
    stream.read(reinterpret_cast<char*>(header), sizeof header);
    std::string text;
    const std::uint64_t bytes = std::filesystem::file_size(path);
    if (std::memcmp(header, "glTF", 4) == 0) {
      if (!stream || header[2] > bytes || header[3] > bytes - sizeof header) refuse("cut short");
      text.resize(header[3]);
      stream.read(text.data(), header[3]);
      std::uint32_t chunk[2] = {};
      const bool has_binary = static_cast<bool>(stream.read(reinterpret_cast<char*>(chunk), sizeof chunk));
      binary_bytes_ = has_binary ? chunk[0] : 0;
      if (binary_bytes_ > bytes - sizeof header - header[3]) refuse("cut short");
    } else {
      stream.clear();
      stream.seekg(0);
      text.assign(std::istreambuf_iterator<char>(stream), {});
    }
    json_ = Json::parse(text, nullptr, false);
    if (json_.is_discarded()) refuse("its JSON cannot be parsed");
  }

  const Json& array(const char* key, const Json* parent = nullptr) const {
    static const Json none = Json::array();
    const Json& object = parent ? *parent : json_;
    if (!object.is_object()) refuse(fmt::format("what should hold '{}' is not an object", key));
    const auto found = object.find(key);
    if (found == object.end()) return none;
    if (!found->is_array()) refuse(fmt::format("'{}' is not a list", key));
    return *found;
  }

  /// A count, size or index; absent: `otherwise`.
  std::uint64_t natural(const Json& object, const char* key, std::uint64_t otherwise) const {
    if (!object.is_object()) refuse(fmt::format("what should hold '{}' is not an object", key));
    const auto found = object.find(key);
    if (found == object.end()) return otherwise;
    if (!found->is_number_unsigned() || found->get<std::uint64_t>() > largest_mesh_bytes) {
      refuse(fmt::format("'{}' is {}: allowed is a whole number up to {}", key, found->dump(), largest_mesh_bytes));
    }
    return found->get<std::uint64_t>();
  }

  const Json& element(const char* list, const Json& index) const {
    const Json& all = array(list);
    if (!index.is_number_unsigned() || index.get<std::uint64_t>() >= all.size()) {
      refuse(fmt::format("index {} of '{}', which has {}", index.dump(), list, all.size()));
    }
    return all[index.get<std::size_t>()];
  }

  void check_buffers() const {
    const Json& buffers = array("buffers");
    for (std::size_t i = 0; i < buffers.size(); ++i) {
      const std::uint64_t bytes = natural(buffers[i], "byteLength", 0);
      if (i == 0 && !buffers[i].contains("uri") && bytes > binary_bytes_) refuse("its binary chunk is cut short");
    }
    for (const Json& view : array("bufferViews")) {
      if (!view.is_object() || !view.contains("buffer")) refuse("a buffer view without a buffer");
      const std::uint64_t end = natural(view, "byteOffset", 0) + natural(view, "byteLength", 0);
      if (end > natural(element("buffers", view["buffer"]), "byteLength", 0)) refuse("a view that leaves its buffer");
    }
  }

  std::uint64_t element_bytes(const Json& accessor) const {
    static const std::map<std::uint64_t, std::uint64_t> component{{5120, 1}, {5121, 1}, {5122, 2},
                                                                  {5123, 2}, {5125, 4}, {5126, 4}};
    static const std::map<std::string, std::uint64_t> count{{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                            {"MAT2", 4},   {"MAT3", 9}, {"MAT4", 16}};
    const auto type = count.find(accessor.contains("type") && accessor["type"].is_string() ? accessor["type"] : "");
    const auto size = component.find(natural(accessor, "componentType", 0));
    if (type == count.end() || size == component.end()) refuse("an accessor of unknown type");
    return type->second * size->second;
  }

  void check_accessor(const Json& accessor) const {
    const std::uint64_t count = natural(accessor, "count", 0);
    const std::uint64_t bytes = element_bytes(accessor);
    if (accessor.contains("sparse")) refuse("sparse accessors are not supported");
    if (!accessor.contains("bufferView") || count == 0) return;
    const Json& view = element("bufferViews", accessor["bufferView"]);
    const std::uint64_t stride = natural(view, "byteStride", bytes);
    if (stride < bytes && stride != 0) refuse("a view whose stride is smaller than its elements");
    const std::uint64_t end = natural(accessor, "byteOffset", 0) + (count - 1) * std::max(stride, bytes) + bytes;
    if (end > natural(view, "byteLength", 0)) refuse("an accessor that leaves its view");
  }

  void check_size() const {
    std::uint64_t vertices = 0, indices = 0;
    for (const Json& mesh : array("meshes")) {
      for (const Json& primitive : array("primitives", &mesh)) {
        if (!primitive.is_object()) refuse("a primitive that is not an object");
        if (primitive.contains("indices")) indices += natural(element("accessors", primitive["indices"]), "count", 0);
        for (const Json& targets : array("targets", &primitive)) vertices += attribute_count(targets);
        if (primitive.contains("attributes")) vertices += attribute_count(primitive["attributes"]);
        if (vertices > largest_mesh_vertices || indices > 3 * largest_mesh_triangles) {
          refuse(fmt::format("its primitives add up to more than {} vertices or {} triangles", largest_mesh_vertices,
                             largest_mesh_triangles));
        }
      }
    }
  }

  std::uint64_t attribute_count(const Json& attributes) const {
    if (!attributes.is_object()) refuse("attributes that are not an object");
    std::uint64_t most = 0;
    for (const Json& index : attributes) most = std::max(most, natural(element("accessors", index), "count", 0));
    return most;
  }

  /// Children must be nodes with one parent each, so that what hangs from the scenes' roots is a tree, and not deep.
  void check_nodes() const {
    const Json& nodes = array("nodes");
    if (nodes.size() > most_nodes) refuse(fmt::format("more than {} nodes", most_nodes));
    std::vector<std::uint8_t> has_parent(nodes.size(), 0);
    for (const Json& node : nodes) {
      if (node.is_object() && node.contains("mesh")) element("meshes", node["mesh"]);
      for (const Json& child : array("children", &node)) {
        element("nodes", child);
        if (has_parent[child.get<std::size_t>()]++) refuse(fmt::format("node {} has two parents", child.dump()));
      }
    }
    for (const Json& scene : array("scenes")) {
      for (const Json& root : array("nodes", &scene)) {
        element("nodes", root);
        if (has_parent[root.get<std::size_t>()]) refuse(fmt::format("root node {} has a parent", root.dump()));
        check_depth(root.get<std::size_t>());
      }
    }
  }

  void check_depth(std::size_t root) const {
    std::vector<std::pair<std::size_t, int>> open{{root, 0}};
    while (!open.empty()) {
      const auto [node, depth] = open.back();
      open.pop_back();
      if (depth > deepest_node) refuse(fmt::format("nodes nested more than {} deep", deepest_node));
      for (const Json& child : array("children", &array("nodes")[node]))
        open.emplace_back(child.get<std::size_t>(), depth + 1);
    }
  }

  std::string file_;
  Json json_;
  std::uint64_t binary_bytes_ = 0;
};

}  // namespace

void check_gltf(const std::filesystem::path& file) { GltfChecker(file).check(); }

}  // namespace understory
