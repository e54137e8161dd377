#include "core/app/files/gltf.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "core/app/files/json_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/version.h"

namespace drape {

namespace {

template <class Number, int columns>
using Rows = Eigen::Matrix<Number, Eigen::Dynamic, columns, columns == 1 ? Eigen::ColMajor : Eigen::RowMajor>;

// glTF's numbers for a component's type, and for what a buffer view holds.
constexpr int float_component = 5126, unsigned_int_component = 5125;
constexpr int vertex_data = 34962, index_data = 34963, other_data = 0;

/// Texture coordinates that span more are not tiles of a picture, as of UDIM, but lengths, as a CAD program
/// writes them.
constexpr double most_tiles = 10;

constexpr float seconds_between_states = 0.25f;  // of an animation

/// From z upwards to y upwards: a rotation, so triangles keep their orientation.
Rows<float, 3> y_upwards(const Positions& x) {
  Rows<double, 3> turned(x.rows(), 3);
  turned << x.col(0), x.col(2), -x.col(1);
  return turned.cast<float>();
}

class GlbWriter {
 public:
  /// Adds a mesh and a node that shows it, both of the surface's index.
  void add(const GltfSurface& surface) {
    const int node = static_cast<int>(json_["nodes"].size());
    Json primitive = {{"attributes", attributes(surface.state)}};
    Json mesh = {{"name", surface.name}};
    if (surface.uv.rows() > 0) {
      Rows<double, 2> uv = surface.uv;
      const Eigen::RowVector2d least = uv.colwise().minCoeff();
      if (const double extent = (uv.colwise().maxCoeff() - least).maxCoeff(); extent > most_tiles) {
        uv = (uv.rowwise() - least) / extent;
        mesh["extras"]["texcoordScale"] = 1 / extent;
      }
      uv.col(1) = 1 - uv.col(1).array();
      primitive["attributes"]["TEXCOORD_0"] = accessor<float, 2>(uv.cast<float>(), vertex_data);
    }
    if (!surface.earlier.empty()) {
      primitive["targets"] = Json::array();
      Json names = Json::array();
      for (const GltfState& earlier : surface.earlier) {
        primitive["targets"].push_back(attributes(
            {earlier.positions - surface.state.positions, earlier.normals - surface.state.normals}));
        names.push_back("state " + std::to_string(names.size()));
      }
      mesh["weights"] = std::vector<double>(surface.earlier.size(), 0.0);
      mesh["extras"]["targetNames"] = names;  // where Blender and three.js look for them
      animate(node, surface);
    }
    mesh["primitives"] = Json::array();
    for (int p = 0; p < std::max<int>(1, static_cast<int>(surface.piece_names.size())); ++p) {
      std::vector<int> own;
      for (int t = 0; t < surface.triangles.rows(); ++t)
        if (surface.piece.empty() || surface.piece[t] == p) own.push_back(t);
      if (own.empty()) continue;
      const Rows<std::uint32_t, 3> corners = surface.triangles(own, Eigen::all).cast<std::uint32_t>();
      primitive["indices"] = accessor<std::uint32_t, 3>(corners, index_data);
      primitive["material"] = surface.piece.empty() ? static_cast<int>(surface.material)
                                                    : material_of_piece(surface.piece_names[p]);
      mesh["primitives"].push_back(primitive);
    }
    if (surface.uv_length > 0) mesh["extras"]["uv_length"] = surface.uv_length;
    json_["meshes"].push_back(mesh);
    json_["nodes"].push_back({{"name", surface.name}, {"mesh", node}});
  }

  void add(const GltfScene& scene) {
    json_["scene"] = json_["scenes"].size();
    json_["scenes"].push_back({{"name", scene.name}, {"nodes", scene.surfaces}});
  }

  std::string bytes() {
    json_["buffers"] = Json::array({{{"byteLength", binary_.size()}}});
    std::string text = json_text(json_);
    text.resize((text.size() + 3) / 4 * 4, ' ');
    const std::uint64_t size = 12 + 8 + text.size() + 8 + binary_.size();
    if (size > std::numeric_limits<std::uint32_t>::max())
      throw std::runtime_error("the file would have " + std::to_string(size >> 20) +
                               " MiB, and glTF takes 4096; export a single level, or without --frames");
    std::string all;
    all.reserve(size);
    const auto number = [&](std::uint64_t value) { append_bytes(all, static_cast<std::uint32_t>(value)); };
    all += "glTF";
    number(2);
    number(size);
    number(text.size());
    all += "JSON";
    all += text;
    number(binary_.size());
    all.append("BIN\0", 4);
    return all += binary_;
  }

 private:
  static Json material(const char* name, const std::vector<double>& colour) {
    return {{"name", name},
            {"doubleSided", true},
            {"pbrMetallicRoughness",
             {{"baseColorFactor", colour}, {"metallicFactor", 0.0}, {"roughnessFactor", 0.8}}}};
  }

  /// The index of a cloth's material of this name, which is made when it is first asked for.
  int material_of_piece(const std::string& name) {
    Json& all = json_["materials"];
    for (std::size_t k = 0; k < all.size(); ++k)
      if (all[k]["name"] == name) return static_cast<int>(k);
    all.push_back(all[0]);
    all.back()["name"] = name;
    return static_cast<int>(all.size()) - 1;
  }

  Json attributes(const GltfState& state) {
    return {{"POSITION", accessor<float, 3>(y_upwards(state.positions), vertex_data, true)},
            {"NORMAL", accessor<float, 3>(y_upwards(state.normals), vertex_data)}};
  }

  /// Appends rows of numbers to the binary chunk; all have four bytes, so every view is aligned. Indices are
  /// listed one by one.
  template <class Number, int columns>
  int accessor(const Rows<Number, columns>& rows, int target, bool with_bounds = false) {
    const bool indices = target == index_data;
    const std::size_t size = sizeof(Number) * static_cast<std::size_t>(rows.size());
    Json view = {{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", size}};
    if (target != other_data) view["target"] = target;
    binary_.append(reinterpret_cast<const char*>(rows.data()), size);
    Json entry = {{"bufferView", json_["bufferViews"].size()},
                  {"componentType", std::is_same_v<Number, float> ? float_component : unsigned_int_component},
                  {"count", indices ? rows.size() : rows.rows()},
                  {"type", indices || columns == 1 ? "SCALAR"
                           : columns == 2          ? "VEC2"
                                                   : "VEC3"}};
    if (with_bounds) {
      for (int k = 0; k < columns; ++k) {
        entry["min"].push_back(rows.col(k).minCoeff());
        entry["max"].push_back(rows.col(k).maxCoeff());
      }
    }
    json_["bufferViews"].push_back(view);
    json_["accessors"].push_back(entry);
    return static_cast<int>(json_["accessors"].size()) - 1;
  }

  /// Shows the earlier states one after the other, then the last: at the k-th time the k-th target has weight
  /// 1, at the end none has.
  void animate(int node, const GltfSurface& surface) {
    const auto targets = static_cast<Eigen::Index>(surface.earlier.size());
    const float end = seconds_between_states * static_cast<float>(targets);
    const Rows<float, 1> times = Rows<float, 1>::LinSpaced(targets + 1, 0, end);
    const Rows<float, 1> weights = Eigen::MatrixXf::Identity(targets, targets + 1).reshaped();
    const int input = accessor<float, 1>(times, other_data, true),
              output = accessor<float, 1>(weights, other_data);
    Json sampler = {{"input", input}, {"interpolation", "LINEAR"}, {"output", output}};
    Json channel = {{"sampler", 0}, {"target", {{"node", node}, {"path", "weights"}}}};
    json_["animations"].push_back(
        {{"name", surface.name}, {"samplers", Json::array({sampler})}, {"channels", Json::array({channel})}});
  }

  Json json_ = {{"asset", {{"version", "2.0"}, {"generator", std::string("drape ") + version()}}},
                {"scene", 0},
                {"scenes", Json::array()},
                {"nodes", Json::array()},
                {"meshes", Json::array()},
                {"materials", Json::array({material("cloth", {0.50, 0.60, 0.75, 1.0}),
                                           material("obstacle", {0.6, 0.6, 0.6, 1.0})})},
                {"accessors", Json::array()},
                {"bufferViews", Json::array()}};
  std::string binary_;
};

}  // namespace

std::string glb_bytes(const std::vector<GltfSurface>& surfaces, const std::vector<GltfScene>& scenes) {
  GlbWriter writer;
  for (const GltfSurface& surface : surfaces) writer.add(surface);
  for (const GltfScene& scene : scenes) writer.add(scene);
  return writer.bytes();
}

}  // namespace drape
