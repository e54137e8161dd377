#pragma once

#include "core/app/experiment/experiment.h"
#include "core/app/scene/scene.h"

namespace drape {

/// The result of a garment that was dressed. Where it has come to rest on the finest level, its message says
/// which piece is stretched by more than half, and through which openings no part of the body passes
/// (not_worn_text). The latter is `infeasible` if the experiment has `dress.worn`.
LevelResult with_verdict(const Experiment& experiment, const Scene& scene, LevelResult result);

}  // namespace drape
