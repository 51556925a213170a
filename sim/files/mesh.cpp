// Meshes through assimp: structure checked, transforms applied, parts named, equal vertices joined, z up.
#include "sim/files/mesh.hpp"

#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <fmt/format.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "sim/error.hpp"
#include "sim/files/gltf_limits.hpp"
#include "sim/files/ply_limits.hpp"
#include "sim/files/text.hpp"

namespace understory {
namespace {

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& what) {
  throw Error(ErrorKind::invalid_input, file.string() + ": " + what);
}

std::string lower_extension(const std::filesystem::path& file) {
  std::string extension = file.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return extension;
}

void check_file(const std::filesystem::path& file) {
  std::error_code failure;
  if (!std::filesystem::exists(file, failure)) refuse(file, "there is no such mesh file");
  if (!std::filesystem::is_regular_file(file, failure)) refuse(file, "not a file");
  const std::string extension = lower_extension(file);
  const bool is_gltf = extension == ".gltf" || extension == ".glb";
  if (!is_gltf && extension != ".obj" && extension != ".ply") {
    refuse(file, fmt::format("'{}': allowed meshes are .obj, .ply, .gltf and .glb", extension));
  }
  const std::uintmax_t bytes = std::filesystem::file_size(file, failure);
  if (failure) throw Error(ErrorKind::input_output, file.string() + ": cannot be read: " + failure.message());
  if (bytes == 0) refuse(file, "an empty file, not a mesh");
  if (bytes > largest_mesh_bytes) {
    refuse(file, fmt::format("{} bytes: a mesh file may have {} at most", bytes, largest_mesh_bytes));
  }
  if (is_gltf) check_gltf(file);
  if (extension == ".ply") check_ply(file);
}

struct PositionHash {
  std::size_t operator()(const glm::vec3& p) const {
    std::uint64_t hash = 0;
    for (const float value : {p.x, p.y, p.z}) {
      hash = (hash ^ std::bit_cast<std::uint32_t>(value)) * 0x9E3779B97F4A7C15u;  // 2^64 / golden ratio: spreads bits
      hash ^= hash >> 29;
    }
    return hash;
  }
};

/// Walks assimp's nodes and collects one part per node and mesh.
class PartCollector {
 public:
  PartCollector(const std::filesystem::path& file, const aiScene& scene, UpAxis up,
                const std::vector<std::string>& leaf_patterns, const std::vector<std::string>& blade_patterns)
      : file_(file), scene_(scene), up_(up), leaf_patterns_(leaf_patterns), blade_patterns_(blade_patterns) {}

  RawMesh collect() {
    visit(*scene_.mRootNode, aiMatrix4x4());
    if (mesh_.parts.empty()) refuse(file_, "the mesh has no faces");
    return std::move(mesh_);
  }

 private:
  void visit(const aiNode& node, const aiMatrix4x4& parent) {
    const aiMatrix4x4 to_file = parent * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(node, *scene_.mMeshes[node.mMeshes[i]], to_file);
    for (unsigned i = 0; i < node.mNumChildren; ++i) visit(*node.mChildren[i], to_file);
  }

  void add(const aiNode& node, const aiMesh& source, const aiMatrix4x4& to_file) {
    vertices_ += source.mNumVertices;
    triangles_ += source.mNumFaces;
    if (vertices_ > largest_mesh_vertices || triangles_ > largest_mesh_triangles) {
      refuse(file_,
             fmt::format("more than {} vertices or {} triangles", largest_mesh_vertices, largest_mesh_triangles));
    }
    RawMesh::Part part;
    part.name = node.mName.length ? node.mName.C_Str() : source.mName.C_Str();
    part.material = scene_.mMaterials[source.mMaterialIndex]->GetName().C_Str();
    part.surface = surface_of(part.material);
    copy_triangles(source, to_file, part);
    if (!part.triangles.empty()) mesh_.parts.push_back(std::move(part));
  }

  SurfaceClass surface_of(const std::string& material) const {
    const auto matches = [&](const std::string& pattern) { return matches_pattern(material, pattern); };
    if (std::any_of(blade_patterns_.begin(), blade_patterns_.end(), matches)) return SurfaceClass::blade;
    return std::any_of(leaf_patterns_.begin(), leaf_patterns_.end(), matches) ? SurfaceClass::leaf : SurfaceClass::wood;
  }

  void copy_triangles(const aiMesh& source, const aiMatrix4x4& to_file, RawMesh::Part& part) {
    constexpr std::uint32_t unused = ~0u;
    std::vector<std::uint32_t> index_of(source.mNumVertices, unused);
    std::unordered_map<glm::vec3, std::uint32_t, PositionHash> joined;
    joined.reserve(source.mNumFaces);
    part.triangles.reserve(std::size_t{source.mNumFaces} * 3);
    for (unsigned f = 0; f < source.mNumFaces; ++f) {
      const aiFace& face = source.mFaces[f];
      if (face.mNumIndices != 3) continue;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned vertex = face.mIndices[k];
        if (vertex >= source.mNumVertices) {
          refuse(file_,
                 fmt::format("face {} of part '{}' names vertex {} of {}", f, part.name, vertex, source.mNumVertices));
        }
        if (index_of[vertex] == unused) {
          const glm::vec3 position = position_of(source, vertex, to_file, part.name);
          const auto [place, is_new] = joined.try_emplace(position, static_cast<std::uint32_t>(part.positions.size()));
          if (is_new) part.positions.push_back(position);
          index_of[vertex] = place->second;
        }
        part.triangles.push_back(index_of[vertex]);
      }
    }
  }

  glm::vec3 position_of(const aiMesh& source, unsigned vertex, const aiMatrix4x4& to_file,
                        const std::string& part) const {
    const aiVector3D p = to_file * source.mVertices[vertex];
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) {
      refuse(file_, fmt::format("vertex {} of part '{}' is ({}, {}, {}): coordinates must be finite", vertex, part, p.x,
                                p.y, p.z));
    }
    const glm::vec3 turned = up_ == UpAxis::z ? glm::vec3(p.x, p.y, p.z) : glm::vec3(p.x, -p.z, p.y);
    return turned + 0.0f;  // -0 becomes 0, so that equal positions have equal bits
  }

  const std::filesystem::path& file_;
  const aiScene& scene_;
  UpAxis up_;
  const std::vector<std::string>&leaf_patterns_, &blade_patterns_;
  RawMesh mesh_;
  std::uint64_t vertices_ = 0, triangles_ = 0;
};

}  // namespace

RawMesh read_mesh(const std::filesystem::path& file, UpAxis up, const std::vector<std::string>& leaf_patterns,
                  const std::vector<std::string>& blade_patterns) {
  check_file(file);
  Assimp::Importer importer;
  importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
  const aiScene* scene =
      importer.ReadFile(file.string(), aiProcess_ValidateDataStructure | aiProcess_Triangulate | aiProcess_SortByPType);
  if (!scene) {
    std::string reason = importer.GetErrorString();
    if (reason.find("contains no faces") != std::string::npos || reason == "No meshes remaining")
      refuse(file, "the mesh has no faces");
    refuse(file, "not a usable mesh: " + readable(reason));
  }
  if (!scene->mRootNode || scene->mNumMeshes == 0) refuse(file, "the mesh has no faces");
  return PartCollector(file, *scene, up, leaf_patterns, blade_patterns).collect();
}

}  // namespace understory
