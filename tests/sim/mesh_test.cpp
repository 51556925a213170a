// Meshes of each format come out with the right triangles, axes, names and classes; broken ones say what is wrong.
#include "sim/files/mesh.hpp"

#include <gmock/gmock.h>

#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>
#include <set>

#include "tests/support/data.hpp"
#include "tests/support/errors.hpp"
#include "tests/support/temporary_file.hpp"

namespace understory {
namespace {

using testing::AllOf;
using testing::HasSubstr;

const std::filesystem::path source_folder = UNDERSTORY_SOURCE_FOLDER;

std::string text_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

RawMesh read_text(const std::string& name, const std::string& text, UpAxis up = UpAxis::z) {
  return read_mesh(TemporaryFile(name, text).path(), up);
}

std::string refusal(const std::string& name, const std::string& text) {
  return message_of(ErrorKind::invalid_input, [&] { read_text(name, text); });
}

std::size_t triangle_count(const RawMesh& mesh) {
  std::size_t count = 0;
  for (const RawMesh::Part& part : mesh.parts) count += part.triangles.size() / 3;
  return count;
}

void expect_sound(const RawMesh& mesh, const std::string& name) {
  EXPECT_FALSE(mesh.parts.empty()) << name;
  for (const RawMesh::Part& part : mesh.parts) {
    EXPECT_FALSE(part.triangles.empty()) << name;
    EXPECT_EQ(part.triangles.size() % 3, 0u) << name;
    std::vector<bool> used(part.positions.size(), false);
    for (const std::uint32_t index : part.triangles) {
      ASSERT_LT(index, part.positions.size()) << name;
      used[index] = true;
    }
    EXPECT_EQ(std::count(used.begin(), used.end(), false), 0) << name << ": vertices that no triangle uses";
  }
}

/// A .glb of one triangle; `edit` may damage its JSON.
template <class Edit>
std::string glb(Edit edit) {
  nlohmann::json json = nlohmann::json::parse(R"({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
    "nodes": [{"mesh": 0, "name": "one", "translation": [1, 2, 3]}], "materials": [{"name": "Leaf_upper"}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1, "material": 0}]}],
    "buffers": [{"byteLength": 48}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 12}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]},
                  {"bufferView": 1, "componentType": 5125, "count": 3, "type": "SCALAR"}]})");
  edit(json);
  std::string text = json.dump();
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const float positions[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
  const std::uint32_t indices[] = {0, 1, 2};
  std::string out = "glTF";
  const auto word = [&out](std::size_t value) {
    const auto narrow = static_cast<std::uint32_t>(value);
    out.append(reinterpret_cast<const char*>(&narrow), 4);
  };
  word(2), word(12 + 8 + text.size() + 8 + 48);
  word(text.size()), out += "JSON", out += text;
  word(48), out.append("BIN\0", 4);
  out.append(reinterpret_cast<const char*>(positions), 36).append(reinterpret_cast<const char*>(indices), 12);
  return out;
}

TEST(Mesh, TurnsItsUpAxisToZ) {
  const std::string triangle = "v 1 2 3\nv 4 5 6\nv 7 8 10\nf 1 2 3\n";
  EXPECT_EQ(read_text("a.obj", triangle, UpAxis::z).parts.at(0).positions.at(0), glm::vec3(1, 2, 3));
  EXPECT_EQ(read_text("a.obj", triangle, UpAxis::y).parts.at(0).positions.at(0), glm::vec3(1, -3, 2));
}

TEST(Mesh, JoinsEqualVerticesAndSplitsPolygons) {
  const RawMesh mesh = read_text("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv -0 0 0\nf 1 2 3 4\nf 5 3 4\n");
  EXPECT_EQ(triangle_count(mesh), 3u);
  EXPECT_EQ(mesh.parts.at(0).positions.size(), 4u);  // the fifth equals the first
}

TEST(Mesh, AppliesNodesAndTellsLeavesByMaterial) {
  const TemporaryFile file("a.glb", glb([](nlohmann::json&) {}));
  const RawMesh mesh = read_mesh(file.path(), UpAxis::z, {"leaf*"});
  ASSERT_EQ(mesh.parts.size(), 1u);
  EXPECT_EQ(mesh.parts[0].name, "one");
  EXPECT_EQ(mesh.parts[0].material, "Leaf_upper");
  EXPECT_EQ(mesh.parts[0].surface, SurfaceClass::leaf);
  EXPECT_EQ(mesh.parts[0].positions.at(0), glm::vec3(1, 2, 3));
  EXPECT_EQ(read_mesh(file.path(), UpAxis::z, {"needle*"}).parts[0].surface, SurfaceClass::wood);
}

TEST(Mesh, SaplingHasWoodAndLeaves) {
  const RawMesh mesh = read_mesh(source_folder / "sim/scenes/sapling.obj", UpAxis::y, {"leaf*"});
  ASSERT_EQ(mesh.parts.size(), 2u);
  EXPECT_EQ(mesh.parts[0].surface, SurfaceClass::wood);
  EXPECT_EQ(mesh.parts[1].surface, SurfaceClass::leaf);
  EXPECT_EQ(triangle_count(mesh), 188u);
}

TEST(Mesh, SaysWhatIsWrong) {
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [] { read_mesh("/no/such.obj", UpAxis::z); }),
              HasSubstr("/no/such.obj: there is no such mesh file"));
  EXPECT_THAT(refusal("a.stl", "solid"), AllOf(HasSubstr("a.stl"), HasSubstr("allowed meshes are .obj, .ply")));
  EXPECT_THAT(refusal("a.obj", ""), HasSubstr("empty file"));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"), HasSubstr("no faces"));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), HasSubstr("no faces"));
  EXPECT_THAT(refusal("a.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"),
              AllOf(HasSubstr("vertex 1"), HasSubstr("finite")));
  EXPECT_THAT(
      refusal("a.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
              "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
      HasSubstr("a.ply"));
  EXPECT_THAT(refusal("a.ply", "ply\nformat ascii 1.0\nelement vertex 4000000000\nproperty float x\nend_header\n"),
              HasSubstr("a.ply"));
  EXPECT_THAT(refusal("a.glb", "not a glb"), HasSubstr("JSON cannot be parsed"));
  const TemporaryFile huge("a.obj", "v");
  std::filesystem::resize_file(huge.path(), largest_mesh_bytes + 1);  // sparse
  EXPECT_THAT(message_of(ErrorKind::invalid_input, [&] { read_mesh(huge.path(), UpAxis::z); }), HasSubstr("at most"));
}

TEST(Mesh, ChecksGltfBeforeItIsBelieved) {
  using Json = nlohmann::json;
  const auto refused = [](auto edit) { return refusal("a.glb", glb(edit)); };
  EXPECT_THAT(refused([](Json& j) { j["accessors"][0]["count"] = 4; }), HasSubstr("leaves its view"));
  EXPECT_THAT(refused([](Json& j) { j["accessors"][0]["count"] = -1; }), HasSubstr("'count' is -1"));
  EXPECT_THAT(refused([](Json& j) { j["accessors"][0]["count"] = 1e300; }), HasSubstr("'count' is 1e+300"));
  EXPECT_THAT(refused([](Json& j) { j["bufferViews"][1]["byteLength"] = 13; }), HasSubstr("leaves its buffer"));
  EXPECT_THAT(refused([](Json& j) { j["bufferViews"][1]["buffer"] = 1; }),
              HasSubstr("index 1 of 'buffers', which has 1"));
  EXPECT_THAT(refused([](Json& j) { j["buffers"][0]["byteLength"] = 49; }), HasSubstr("cut short"));
  EXPECT_THAT(refused([](Json& j) { j["meshes"][0]["primitives"][0]["indices"] = 9; }), HasSubstr("index 9"));
  EXPECT_THAT(refused([](Json& j) { j["nodes"][0]["children"] = {0}; }), HasSubstr("has a parent"));
  EXPECT_THAT(refused([](Json& j) {
                j["nodes"] = Json::parse(R"([{"children": [1]}, {"children": [2]}, {"children": [1]}])");
              }),
              HasSubstr("two parents"));
  EXPECT_THAT(refused([](Json& j) { j["nodes"] = 3; }), HasSubstr("'nodes' is not a list"));
  EXPECT_THAT(refused([](Json& j) {
                for (int i = 0; i < 400; ++i) j["nodes"].push_back({{"children", {i + 2}}});
                j["nodes"].push_back(Json::object());
                j["nodes"][0]["children"] = {1};
              }),
              HasSubstr("nested more than"));
  // Twenty thousand primitives that share one accessor of two million vertices (assimp#4998).
  EXPECT_THAT(refused([](Json& j) {
                const Json primitive = j["meshes"][0]["primitives"][0];
                for (int i = 0; i < 20'000; ++i) j["meshes"][0]["primitives"].push_back(primitive);
                j["accessors"][0] = {{"componentType", 5126}, {"count", 2'000'000}, {"type", "VEC3"}};
              }),
              HasSubstr("add up to more than"));
}

TEST(Mesh, SurvivesDamage) {
  std::mt19937 random(3);
  const std::string whole_glb = glb([](nlohmann::json&) {});
  const std::string whole_obj = text_of(source_folder / "sim/scenes/sapling.obj").substr(0, 4000);
  const auto attempt = [](const std::string& name, const std::string& text) {
    try {
      expect_sound(read_text(name, text), name);
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << error.what();
    }
  };
  for (std::size_t size = 1; size < whole_glb.size(); size += 5) attempt("a.glb", whole_glb.substr(0, size));
  for (int round = 0; round < 500; ++round) {
    std::string glb_bytes = whole_glb, obj_bytes = whole_obj;
    for (int k = 0; k < 2; ++k) {
      glb_bytes[random() % glb_bytes.size()] = static_cast<char>(random());
      obj_bytes[random() % obj_bytes.size()] = "0123456789-. /nvf\n"[random() % 18];
    }
    attempt("a.glb", glb_bytes);
    attempt("a.obj", obj_bytes);
  }
}

TEST(RealMeshes, AllOpenWithTheStatedTriangles) {
  UNDERSTORY_NEEDS_DATA();
  const std::map<std::string, std::size_t> stated{// MANIFEST.md
                                                  {"plants/tree_broadleaf_black_oak.glb", 534'713},
                                                  {"plants/tree_poplar_lombardy.glb", 63'713},
                                                  {"plants/tree_multicrown_oak_cards.glb", 22'566},
                                                  {"plants/tree_walnut_digitized.glb", 153'520},
                                                  {"plants/tree_scanned_qsm_coffeetree.glb", 45'960},
                                                  {"plants/sapling_eucalyptus_pilularis.glb", 29'104},
                                                  {"plants/shrub_bougainvillea.glb", 127'569},
                                                  {"plants/grass_wheat_6x6.glb", 293'184},
                                                  {"plants/grass_lawn_2m.glb", 248'832},
                                                  {"plants/birch.glb", 129'864},
                                                  {"occluders/spot_cow.obj", 23'062},
                                                  {"occluders/penguin.obj", 26'880},
                                                  {"occluders/human_man.obj", 13'776},
                                                  {"milk_truck/milk_truck_parts.obj", 3'624},
                                                  {"milk_truck/milk_truck_frame0.ply", 3'624},
                                                  {"terrain_maunga_whau.ply", 10'320},
                                                  {"tree_walnut_crown_hull_multi.ply", 462},
                                                  {"tree_walnut_crown_hull_single.ply", 146},
                                                  {"tree_walnut_digitized.ply", 153'520},
                                                  {"tree_poplar_lombardy.ply", 63'713},
                                                  {"shrub_bougainvillea.ply", 127'569}};
  for (const auto& [name, triangles] : stated) {
    const RawMesh mesh = read_mesh(data_folder() / name, UpAxis::y, {"leaf*", "flower*", "blade*"});
    expect_sound(mesh, name);
    EXPECT_EQ(triangle_count(mesh), triangles) << name;
  }
  EXPECT_THAT(message_of(ErrorKind::invalid_input,
                         [] { read_mesh(data_folder() / "birch_wind/birch_wind_f05_points.ply", UpAxis::z); }),
              HasSubstr("no faces"));
}

TEST(RealMeshes, MilkTruckKeepsItsParts) {
  UNDERSTORY_NEEDS_DATA();
  std::set<std::string> names;
  for (const auto& part : read_mesh(data_folder() / "milk_truck/milk_truck_parts.obj", UpAxis::y).parts)
    names.insert(part.name);
  EXPECT_THAT(names, testing::UnorderedElementsAre("body", "wheels_front", "wheels_rear"));
}

TEST(RealMeshes, OakIsLeafAndWoodAndStands) {
  UNDERSTORY_NEEDS_DATA();
  const RawMesh oak = read_mesh(data_folder() / "plants/tree_broadleaf_black_oak.glb", UpAxis::y, {"leaf*"});
  float low = 1e9f, high = -1e9f;
  std::size_t leaf_triangles = 0;
  for (const RawMesh::Part& part : oak.parts) {
    if (part.surface == SurfaceClass::leaf) leaf_triangles += part.triangles.size() / 3;
    for (const glm::vec3& p : part.positions) low = std::min(low, p.z), high = std::max(high, p.z);
  }
  EXPECT_EQ(leaf_triangles, 438'654u);
  EXPECT_NEAR(high - low, 10.7f, 0.06f);
}

TEST(RealMeshes, SurviveDamage) {
  UNDERSTORY_NEEDS_DATA();
  std::mt19937 random(9);
  for (const char* name : {"tree_walnut_crown_hull_multi.ply", "terrain_maunga_whau.ply",
                           "milk_truck/milk_truck_parts.obj", "plants/tree_multicrown_oak_cards.glb"}) {
    const std::string whole = text_of(data_folder() / name);
    const std::string file_name = std::filesystem::path(name).filename().string();
    for (int round = 0; round < 40; ++round) {
      std::string damaged = whole.substr(0, round % 2 ? whole.size() : random() % whole.size());
      for (int k = 0; k < 3 && !damaged.empty(); ++k) {
        const std::size_t reach =
            round % 4 < 2 ? damaged.size() : std::min<std::size_t>(damaged.size(), 400);  // headers
        damaged[random() % reach] = static_cast<char>(random());
      }
      try {
        expect_sound(read_text(file_name, damaged), file_name);
      } catch (const Error& error) {
        EXPECT_EQ(error.kind(), ErrorKind::invalid_input) << error.what();
      }
    }
  }
}

}  // namespace
}  // namespace understory
