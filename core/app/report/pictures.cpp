#include "core/app/report/pictures.h"

#include <algorithm>
#include <cctype>

#include "core/app/report/picture_canvas.h"
#include "core/kernel/files/file.h"

namespace drape {

namespace {

/// Keeps a method's name as it is: a run accepts only names of files, and distinct methods need distinct
/// pictures. Only an edited results.json or a metric's declaration can have anything else.
std::string file_part(std::string name) {
  for (char& c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && !std::isalnum(byte) && c != '-' && c != '.') c = '_';
  }
  return name;
}

void draw_states(const RunData& run, PictureCanvas& canvas) {
  for (const MethodRecord& method : run.methods)
    for (const LevelRecord& level : method.levels)
      if (const TriangleMesh* state = canvas.scene().state(method.name, level.level))
        canvas.draw(state_picture(method, level.level), plain_cloth(*state));
}

/// Each method's finest state with the outline of its coarsest, over the pictures of the states.
void draw_outlines(const RunData& run, PictureCanvas& canvas, const PictureSet& set) {
  for (const MethodRecord& method : run.methods) {
    const std::optional<LevelPair> levels = widest_levels(method);
    if (!levels) continue;
    const TriangleMesh* coarse = canvas.scene().state(method.name, levels->coarse);
    const Picture* fine = set.find(state_picture(method, levels->fine));
    if (coarse && fine) canvas.draw_outlined(outline_picture(method, *levels), fine->image, *coarse);
  }
}

/// Removes what an earlier report drew and this one did not, as of a state whose mesh is gone.
void remove_stale(const RunData& run, const PictureSet& set) {
  const auto is_of = [](const std::string& name, const MethodRecord& method) {
    const std::string begin = file_part(method.name) + "_l";
    return name.starts_with(begin) && name.ends_with(".png") &&
           std::isdigit(static_cast<unsigned char>(name[begin.size()]));
  };
  std::vector<std::filesystem::path> stale;
  for (const auto& entry : std::filesystem::directory_iterator(run.folder / "pictures")) {
    const std::string name = entry.path().filename().string();
    const bool own = std::any_of(run.methods.begin(), run.methods.end(),
                                 [&](const MethodRecord& method) { return is_of(name, method); });
    if (own && !set.pictures.contains(name)) stale.push_back(entry.path());
  }
  for (const std::filesystem::path& picture : stale) std::filesystem::remove(picture);
}

}  // namespace

const Picture* PictureSet::find(const std::string& name) const {
  const auto found = pictures.find(name);
  return found == pictures.end() ? nullptr : &found->second;
}

std::string state_picture(const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + ".png";
}

std::string outline_picture(const MethodRecord& method, const LevelPair& levels) {
  return file_part(method.name) + "_l" + std::to_string(levels.coarse) + "_on_l" +
         std::to_string(levels.fine) + ".png";
}

std::optional<LevelPair> widest_levels(const MethodRecord& method) {
  std::optional<LevelPair> widest;
  for (const LevelRecord& level : method.levels) {
    if (level.mesh.empty()) continue;
    if (!widest) widest = {level.level, level.level};
    widest->fine = level.level;
  }
  return widest && widest->fine > widest->coarse ? widest : std::nullopt;
}

PictureSet draw_pictures(const RunData& run, const std::function<bool()>& cancelled,
                         std::optional<int> width) {
  PictureSet set;
  make_folder(run.folder / "pictures");
  PictureCanvas canvas(run, cancelled, width.value_or(default_picture_width), set);
  try {
    draw_states(run, canvas);
    draw_outlines(run, canvas, set);
    remove_stale(run, set);
  } catch (const RenderingCancelled&) {
    set.notes.push_back("The run was stopped before all pictures were drawn; drape report " +
                        run.folder.string() + " draws them.");
  }
  return set;
}

}  // namespace drape
