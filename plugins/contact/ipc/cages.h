#pragma once

#include <string>

#include "core/kernel/plugin/declaration.h"
#include "plugins/contact/ipc/validated_mesh.h"

namespace drape::ipc {

/// Nested closed surfaces around an obstacle, which replace it on coarse levels of the cloth.
struct CageParameters {
  int count = 0;
  /// Alpha and offset of the innermost cage, over the diagonal of the mesh's bounding box.
  double alpha = 0.05, offset = 0.01;
  double growth = 2;  ///< factor on both from one cage to the next outer one

  static void declare(Declaration<CageParameters>& d);
  bool operator==(const CageParameters&) const = default;
};

/// The cages, outermost first: alpha wraps (Portaneri et al. 2022) of the mesh, of that wrap, and so on.
/// Throws std::runtime_error if a cage does not enclose the next, by exact predicates.
ValidatedMeshes make_cages(const ValidatedMesh& mesh, const CageParameters& parameters);

/// Why `outer` does not enclose `inner`, by exact predicates. Empty if `outer` is closed, free of
/// self-intersections and of contact with `inner`, and has all components of `inner` inside.
std::string enclosure_fault(const ValidatedMesh& outer, const ValidatedMesh& inner);

}  // namespace drape::ipc
