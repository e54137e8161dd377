#include "core/app/report/picture_canvas.h"

#include "core/app/picture/outline.h"
#include "core/kernel/files/file.h"

namespace drape {

PictureCanvas::PictureCanvas(const RunData& run, const std::function<bool()>& cancelled, int width,
                             PictureSet& set)
    : run_(run),
      cancelled_(cancelled),
      width_(width),
      height_(picture_height(width)),
      set_(set),
      scene_(run, set.notes, {.width = width}) {}

void PictureCanvas::draw(const std::string& name, const Drawing& drawing) {
  if (!renderer_) renderer_ = std::make_unique<Renderer>(width_, height_, cancelled_);
  keep(name, scene_.draw(*renderer_, drawing));
}

void PictureCanvas::draw_outlined(const std::string& name, Image picture, const TriangleMesh& state) {
  if (cancelled_ && cancelled_()) throw RenderingCancelled();
  draw_outline(picture, state, scene_.camera(), outline_colour());
  keep(name, std::move(picture));
}

void PictureCanvas::keep(const std::string& name, Image image) {
  std::string png = encode_png(image);
  write_file(run_.folder / "pictures" / name, png);
  set_.pictures.insert_or_assign(name, Picture{std::move(image), std::move(png)});
}

}  // namespace drape
