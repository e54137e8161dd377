#include "core/app/report/pictures.h"

#include <cctype>

#include "core/app/report/field_pictures.h"
#include "core/app/report/picture_canvas.h"
#include "core/kernel/mesh/file.h"

namespace drape {

namespace {

constexpr int most_vertices_with_edges = 4000;  // more lines would merge

std::string file_part(std::string name) {
  for (char& c : name) {
    if (!std::isalnum(static_cast<unsigned char>(c)) && c != '-') c = '_';
  }
  return name;
}

void draw_states(const RunData& run, PictureCanvas& canvas) {
  for (const MethodRecord& method : run.methods)
    for (const LevelRecord& level : method.levels)
      if (const TriangleMesh* state = canvas.state(method.name, level.level))
        canvas.draw(state_picture(method, level.level),
                    {.mesh = *state, .edges = state->vertices.rows() <= most_vertices_with_edges});
}

}  // namespace

const Picture* PictureSet::find(const std::string& name) const {
  const auto found = pictures.find(name);
  return found == pictures.end() ? nullptr : &found->second;
}

std::string state_picture(const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + ".png";
}

std::string threshold_picture(const MetricPicture& picture, const MethodRecord& method, int level) {
  return file_part(method.name) + "_l" + std::to_string(level) + "_" + file_part(picture.name) + ".png";
}

std::string difference_picture(const MetricPicture& picture, const MethodRecord& method,
                               const ConsistencyRecord& pair) {
  return file_part(method.name) + "_l" + std::to_string(pair.coarse) + "_l" + std::to_string(pair.fine) +
         "_" + file_part(picture.name) + ".png";
}

const ConsistencyRecord* widest_pair(const MethodRecord& method) {
  const ConsistencyRecord* widest = nullptr;
  for (const ConsistencyRecord& pair : method.consistency) {
    const bool wider = !widest || pair.coarse < widest->coarse ||
                       (pair.coarse == widest->coarse && pair.fine > widest->fine);
    if (wider) widest = &pair;
  }
  return widest;
}

PictureSet draw_pictures(const RunData& run, const std::function<bool()>& leave) {
  PictureSet set;
  make_folder(run.folder / "pictures");
  for (const DeclaredMetric& metric : run.metrics)
    for (const MetricPicture& picture : metric.declaration.pictures) set.fields.push_back({picture});
  PictureCanvas canvas(run, leave, set);
  try {
    draw_states(run, canvas);
    draw_fields(run, canvas, set);
  } catch (const PictureLeft&) {
    set.notes.push_back("The run was stopped before all pictures were drawn; drape report " +
                        run.folder.string() + " draws them.");
  }
  return set;
}

}  // namespace drape
