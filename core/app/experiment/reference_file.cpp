#include "core/app/experiment/reference_file.h"

#include "core/numerics/linear_algebra/same_entries.h"
#include "core/numerics/mesh_files/io.h"

namespace drape {

std::optional<Positions> read_reference(const Experiment& experiment, const Hierarchy& hierarchy,
                                        ConfigErrors& errors) {
  const std::string& named = experiment.parameters.reference.file;
  if (named.empty()) return std::nullopt;
  const auto refuse = [&](const std::string& why) {
    errors.push_back({experiment.location_of("reference"), "\"reference\": " + why});
    return std::nullopt;
  };
  std::filesystem::path file = named;
  if (std::filesystem::is_directory(file)) {
    file /= "reference.ply";
    if (!std::filesystem::is_regular_file(file))
      return refuse(named + " holds no reference.ply; name a mesh, as in " + named +
                    "/levels/newton_l3.ply, or run that experiment with a reference of its own");
  }
  try {
    const TriangleMesh mesh = read_mesh(file);
    const Level& finest = hierarchy.levels.back();
    if (mesh.vertices.rows() != finest.vertex_count())
      return refuse(file.string() + " has " + std::to_string(mesh.vertices.rows()) +
                    " vertices, but the finest level has " + std::to_string(finest.vertex_count()) +
                    "; take a state of that level");
    if (!same_entries(mesh.triangles, finest.rest.triangles))
      return refuse(file.string() + " has other triangles than the finest level; take a state of that level");
    return mesh.vertices;
  } catch (const std::exception& problem) {
    return refuse(problem.what());
  }
}

}  // namespace drape
