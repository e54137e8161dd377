#pragma once

#include <memory>
#include <vector>

#include "core/plugin/parameters.h"
#include "plugins/contact/ipc/sound_mesh.h"

namespace drape {

/// Closed surfaces around an obstacle, each around the next: what coarse levels of the cloth meet.
struct CageParameters {
  int count = 0;
  double alpha = 0.05, offset = 0.01, growth = 2;

  static void declare(Declaration<CageParameters>& d);
  bool operator==(const CageParameters&) const = default;
};

/// The outermost first; made once for as long as somebody has them. Alpha wraps (Portaneri et al. 2022) of a
/// mesh, of that wrap, and so on. Throws std::runtime_error if one is not around the next, by exact
/// predicates.
std::shared_ptr<const std::vector<std::shared_ptr<const SoundMesh>>> cages_of(
    const std::shared_ptr<const SoundMesh>& mesh, const CageParameters& parameters);

/// Why `outer` is not around `inner`, by exact predicates: empty if it is closed, does not intersect itself
/// nor touch `inner`, and has all of its parts inside.
std::string why_not_around(const SoundMesh& outer, const SoundMesh& inner);

}  // namespace drape
