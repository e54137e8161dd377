#pragma once

#include "core/app/report/picture_canvas.h"

namespace drape {

/// Draws the fields of set.fields for every method that has them, and sets their scales. Throws
/// RenderingCancelled.
void draw_fields(const RunData& run, PictureCanvas& canvas, PictureSet& set);

}  // namespace drape
