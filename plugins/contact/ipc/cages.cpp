#include "plugins/contact/ipc/cages.h"

#include <stdexcept>
#include <vector>

#include "core/kernel/plugin/parameters.h"
#include "core/numerics/collision_detection/components.h"
#include "core/numerics/collision_detection/intersections.h"
#include "core/numerics/dressing/implicit_smoothing.h"
#include "core/numerics/mesh/check.h"
#include "core/numerics/mesh/repair.h"

namespace drape::ipc {
namespace {

/// The wrap first splits the mesh into pieces of about alpha. Throws if they would exceed memory: a folded
/// mesh has many times the area of its box, so bounds on alpha do not suffice.
void check_piece_count(const TriangleMesh& mesh, double alpha) {
  constexpr double max_pieces = 2e7;
  if (surface_area(mesh) / (alpha * alpha) > max_pieces)
    throw std::runtime_error(
        "a cage would take more than 20 million pieces of its mesh; raise the cages' alpha");
}

std::shared_ptr<const ValidatedMesh> wrap(const TriangleMesh& mesh, double alpha, double offset) {
  check_piece_count(mesh, alpha);
  TriangleMesh cage = alpha_wrap(mesh, alpha, offset);
  if (const auto faults = check_mesh(cage); !faults.empty()) throw std::runtime_error(faults[0]);
  return ValidatedMesh::of(std::move(cage));
}

}  // namespace

void CageParameters::declare(Declaration<CageParameters>& d) {
  using P = CageParameters;
  d.add("count", &P::count,
        "number of cages: level l of the cloth collides with cage l, finer levels with the obstacle "
        "itself")
      .between(0, 8);
  d.add("alpha", &P::alpha,
        "alpha of the innermost cage's alpha wrap, relative to the diagonal of the mesh's bounding box; "
        "sets the size of the holes that are closed, and of triangles")
      .at_least(5e-3)
      .below(1)
      .source("Portaneri et al. 2022");
  d.add("offset", &P::offset, "offset of the innermost cage from the mesh, over the same diagonal")
      .at_least(1e-4)
      .below(1)
      .source("Portaneri et al. 2022");
  d.add("growth", &P::growth, "ratio of a cage's alpha and offset to those of the next finer one")
      .between(1, 10);
}

std::string enclosure_fault(const ValidatedMesh& outer, const ValidatedMesh& inner) {
  if ((outer.topology.edge_triangles.col(1).array() < 0).any()) return "it is not closed";
  const auto text = [](const TrianglePair& pair, const std::string& what) {
    return "its triangle " + std::to_string(pair.first) + what + std::to_string(pair.second);
  };
  if (const auto pairs = self_intersections(outer.mesh); !pairs.empty())
    return text(pairs[0], " intersects its triangle ");
  if (const auto pairs = intersections(outer.mesh, inner.mesh); !pairs.empty())
    return text(pairs[0], " intersects that one's triangle ");
  const std::vector<int> one_of_each = components(inner.topology);
  if (const auto outside = first_outside(outer.mesh, inner.mesh.vertices(one_of_each, Eigen::all)))
    return "that one's vertex " + std::to_string(one_of_each[*outside]) + " is outside";
  return "";
}

ValidatedMeshes make_cages(const ValidatedMesh& mesh, const CageParameters& p) {
  ValidatedMeshes cages(p.count);
  double size = bounding_box_diagonal(mesh.mesh.vertices);
  for (int k = p.count - 1; k >= 0; --k, size *= p.growth) {
    const bool innermost = k == p.count - 1;
    const ValidatedMesh& inner = innermost ? mesh : *cages[k + 1];
    cages[k] = wrap(inner.mesh, p.alpha * size, p.offset * size);
    if (const std::string fault = enclosure_fault(*cages[k], inner); !fault.empty())
      throw std::runtime_error("cage " + std::to_string(k) + " does not enclose " +
                               (innermost ? "its mesh" : "cage " + std::to_string(k + 1)) + ": " + fault +
                               "; change the cages' alpha or offset");
  }
  return cages;
}

}  // namespace drape::ipc
