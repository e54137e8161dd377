#pragma once

#include <functional>
#include <memory>
#include <string>

#include "core/app/picture/render.h"
#include "core/app/report/picture_scene.h"
#include "core/app/report/pictures.h"

namespace drape {

/// Draws a report's pictures into the set that takes them, and into files.
class PictureCanvas {
 public:
  /// Pictures are `width` pixels wide. `run`, `cancelled` and `set` must outlive the canvas. What cannot be
  /// read becomes a note of the set.
  PictureCanvas(const RunData& run, const std::function<bool()>& cancelled, int width, PictureSet& set);

  const PictureScene& scene() const { return scene_; }

  /// Draws cloth and obstacles with the common camera and stores the picture. Throws RenderingCancelled.
  void draw(const std::string& name, const Drawing& drawing);
  /// Draws the outline of a state over a picture that this canvas drew and stores the result. Throws
  /// RenderingCancelled.
  void draw_outlined(const std::string& name, Image picture, const TriangleMesh& state);

 private:
  void keep(const std::string& name, Image image);

  const RunData& run_;
  const std::function<bool()>& cancelled_;
  const int width_, height_;
  PictureSet& set_;
  const PictureScene scene_;
  std::unique_ptr<Renderer> renderer_;
};

}  // namespace drape
