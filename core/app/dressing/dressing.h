#pragma once

#include "core/app/scene/scene.h"

namespace drape {

/// Finds a start of a garment around its body, and makes the load stepping that brings it on: the body grows
/// inside the garment, which is then sewn, its strain limits come down, and at last it has weight and
/// friction. Sets `garment`, `starts` and `placed` of the scene, whose models are made and which must outlive
/// the load stepping. Null, with an error appended, if no start is found.
std::unique_ptr<LoadStepping> dress(const Experiment& experiment, Scene& scene, ConfigErrors& errors);

}  // namespace drape
