#pragma once

#include "core/app/scene/scene.h"

namespace drape {

/// Whether a start that intersects something is refused.
enum class IntersectingStart { refused, allowed };

/// Builds the scene of an experiment that is not too large; null if there are errors already, and, with every
/// fault of the mesh, of pins and of the start appended, if that is not possible. An intersecting start is
/// `allowed` for repair_start and warm starts alone.
std::unique_ptr<Scene> build_scene(const Experiment& experiment, ConfigErrors& errors, LargeMemory large,
                                   IntersectingStart intersecting = IntersectingStart::refused);

}  // namespace drape
