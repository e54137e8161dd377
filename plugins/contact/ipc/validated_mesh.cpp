#include "plugins/contact/ipc/validated_mesh.h"

#include <functional>
#include <stdexcept>
#include <string>

#include "core/kernel/mesh/check.h"
#include "core/kernel/mesh/io.h"
#include "core/kernel/mesh/primitives.h"
#include "plugins/contact/ipc/weak_cache.h"

namespace drape::ipc {
namespace {

namespace fs = std::filesystem;

struct Named {
  std::string key;
  ValidatedMesh validated;
};

/// The mesh from make(), cached under a key.
std::shared_ptr<const ValidatedMesh> cached(const std::string& key,
                                            const std::function<TriangleMesh()>& make) {
  static WeakCache<Named> all;
  const auto found = all.find_or_make([&](const Named& named) { return named.key == key; },
                                      [&] {
                                        Named named{key, {make(), {}}};
                                        const TriangleMesh& mesh = named.validated.mesh;
                                        named.validated.topology = Topology::of(
                                            mesh.triangles, static_cast<int>(mesh.vertices.rows()));
                                        return named;
                                      });
  return {found, &found->validated};
}

}  // namespace

std::shared_ptr<const ValidatedMesh> load_validated_mesh(const fs::path& file) {
  std::error_code none;
  std::string key = fs::absolute(file, none).string();
  const auto size = fs::file_size(file, none);
  const auto modified = fs::last_write_time(file, none).time_since_epoch().count();
  key += " " + std::to_string(size) + " " + std::to_string(modified);
  return cached(key, [&] {
    TriangleMesh mesh = read_mesh(file);
    if (const auto faults = check_mesh(mesh); !faults.empty())
      throw std::runtime_error(file.string() + ": " + faults[0]);
    return mesh;
  });
}

std::shared_ptr<const ValidatedMesh> validated_box() { return cached("box", unit_box); }

std::shared_ptr<const ValidatedMesh> validated_sphere(int subdivisions) {
  return cached("sphere " + std::to_string(subdivisions), [&] { return unit_sphere(subdivisions); });
}

}  // namespace drape::ipc
