#include "core/app/report/report.h"

#include <algorithm>
#include <cmath>

#include "core/app/report/chart_data.h"
#include "core/app/report/metric_columns.h"
#include "core/app/report/pictures.h"
#include "core/app/report/report_view.h"
#include "core/app/report/tables.h"
#include "core/app/view/embedded.h"
#include "core/app/view/html.h"
#include "core/kernel/files/file.h"
#include "core/numerics/mesh_files/base64.h"

namespace drape {

namespace {

using html::escape;
using html::number_text;

constexpr std::size_t most_columns = 4;
constexpr std::size_t most_picture_bytes =
    11'000'000;  // as PNG; a third more in the page, beside the 3D data

/// Pictures as data URLs, shrunk when all of them would make the page too large.
class Gallery {
 public:
  explicit Gallery(const PictureSet& set) : set_(set) {
    std::size_t bytes = 0;
    for (const auto& [name, picture] : set.pictures) bytes += picture.png.size();
    shrink_by_ = std::max(1, static_cast<int>(std::ceil(std::sqrt(double(bytes) / most_picture_bytes))));
  }

  std::string shown(const std::string& name, const std::string& alt, const std::string& caption) const {
    const Picture* picture = set_.find(name);
    if (!picture)
      return "<figure class=\"absent\"><p>no picture</p><figcaption>" + caption + "</figcaption></figure>\n";
    const bool whole = shrink_by_ == 1;
    const Image smaller = whole ? Image() : shrink(picture->image, shrink_by_);
    const Image& image = whole ? picture->image : smaller;
    const std::string data = base64(whole ? picture->png : encode_png(image));
    return "<figure><img width=\"" + std::to_string(image.width) + "\" height=\"" +
           std::to_string(image.height) + "\" alt=\"" + escape(alt) + "\" src=\"data:image/png;base64," +
           data + "\"><figcaption>" + caption + "</figcaption></figure>\n";
  }

 private:
  const PictureSet& set_;
  int shrink_by_ = 1;
};

std::string grid_open(std::size_t columns) {
  return "<div class=\"grid\" style=\"--columns:" + std::to_string(columns) + "\">\n";
}

std::string grid_head(const RunData& run) {
  std::string text;
  for (const MethodRecord& method : run.methods) text += "<h3>" + escape(method.name) + "</h3>\n";
  return text;
}

std::string label(const MethodRecord& method, int level) {
  return "<b>" + escape(method.name) + "</b>, level " + std::to_string(level);
}

/// A column for each method; the levels of a single method stand in rows.
std::string state_grid(const RunData& run, const Gallery& gallery) {
  const bool single = run.methods.size() == 1;
  std::string text = single ? grid_open(std::clamp<std::size_t>(run.level_indices().size(), 1, most_columns))
                            : grid_open(run.methods.size()) + grid_head(run);
  for (const int level : run.level_indices()) {
    for (const MethodRecord& method : run.methods) {
      const LevelRecord* r = method.level(level);
      const std::string caption = label(method, level) + ": " +
                                  html::count(r ? r->vertices : OptionalNumber()) + " vertices, " +
                                  number_text(r ? r->energy_released : OptionalNumber()) + "&nbsp;J released";
      text += gallery.shown(state_picture(method, level),
                            method.name + ": the cloth at level " + std::to_string(level), caption);
    }
  }
  return text + "</div>\n";
}

/// What the coarsest states foretold of the finest ones; empty for a run without two levels.
std::string outline_grid(const RunData& run, const Gallery& gallery) {
  std::string figures;
  std::size_t count = 0;
  for (const MethodRecord& method : run.methods) {
    const std::optional<LevelPair> levels = widest_levels(method);
    if (!levels) continue;
    ++count;
    figures += gallery.shown(
        outline_picture(method, *levels),
        method.name + ": the cloth at level " + std::to_string(levels->fine) + " with the outline of level " +
            std::to_string(levels->coarse),
        label(method, levels->fine) + ", with the outline of level " + std::to_string(levels->coarse));
  }
  if (count == 0) return "";
  return "<h3>Outline of the preview</h3>\n<p>The finest state of each method, and as a blue line the "
         "outline "
         "of its coarsest state. The closer the line follows the cloth, the better the preview showed its "
         "shape.</p>\n" +
         grid_open(count) + figures + "</div>\n";
}

std::string difference_grid(const RunData& run, const Gallery& gallery, const FieldPictures& pictures) {
  const MetricPicture& declared = pictures.declared;
  const std::string end = number_text(pictures.scale);
  std::string text = "<p class=\"legend\"><span>−" + end + "</span><i class=\"diverging\"></i><span>+" + end +
                     " " + escape(declared.unit) + "</span></p>\n" + grid_open(run.methods.size());
  for (const MethodRecord& method : run.methods) {
    const ConsistencyRecord* pair = widest_pair(method);
    const std::string levels =
        pair ? "level " + std::to_string(pair->coarse) + " to " + std::to_string(pair->fine) : "no pair";
    std::string caption = "<b>" + escape(method.name) + "</b>, " + levels;
    for (const MetricColumn& column : run.columns(MetricScope::pair, Shown::stored))
      if (column.name == declared.column)
        caption += ": " + label_html(column) + " = " +
                   value_text(column, pair ? pair->metrics.of(column.name) : OptionalNumber());
    text += gallery.shown(pair ? difference_picture(declared, method, *pair) : "",
                          method.name + ": " + declared.label + ", " + levels, caption);
  }
  return text + "</div>\n";
}

std::string threshold_grid(const RunData& run, const Gallery& gallery, const FieldPictures& pictures) {
  const MetricPicture& declared = pictures.declared;
  const std::string threshold = number_text(pictures.scale);
  std::string text = "<p class=\"legend\"><i class=\"below\"></i><span>below −" + threshold +
                     "</span><i class=\"flat\"></i><span>between</span><i class=\"above\"></i><span>above +" +
                     threshold + " " + escape(declared.unit) + "</span></p>\n" +
                     grid_open(run.methods.size()) + grid_head(run);
  for (const int level : run.level_indices()) {
    for (const MethodRecord& method : run.methods) {
      text += gallery.shown(threshold_picture(declared, method, level),
                            method.name + ": " + declared.label + " at level " + std::to_string(level),
                            label(method, level));
    }
  }
  return text + "</div>\n";
}

/// What the pictures of a field have in common, after the metric's own text.
std::string scale_text(const FieldPictures& pictures) {
  if (pictures.declared.kind == PictureKind::difference)
    return std::string("Drawn on ") + (pictures.on_rest ? "the flat rest shape" : "the finer state") +
           ". The scale is equal for all methods and covers " + html::count(100 * difference_quantile) +
           "&nbsp;% of all values; the others have its end colours.";
  return "The threshold is equal everywhere: " + html::count(100 * threshold_quantile) +
         "&nbsp;% of the first method's finest state lie below it. Coarse levels have the values of their "
         "prolonged surface.";
}

/// A section for each field that metrics declare a picture of.
std::string metric_pictures(const RunData& run, const Gallery& gallery, const PictureSet& set) {
  std::string text;
  for (const FieldPictures& pictures : set.fields) {
    const MetricPicture& declared = pictures.declared;
    text += "<section id=\"" + escape(declared.name) + "\">\n<h2>" + escape(declared.title) + "</h2>\n<p>" +
            html::formula(declared.text) + " " + scale_text(pictures) + "</p>\n";
    if (!(pictures.scale > 0))
      text += "<p class=\"absent\">No field was stored for these pictures in this run.</p>\n";
    else
      text += declared.kind == PictureKind::difference ? difference_grid(run, gallery, pictures)
                                                       : threshold_grid(run, gallery, pictures);
    text += "</section>\n\n";
  }
  return text;
}

std::string verdict_line(const RunData& run) {
  const std::optional<Verdict> verdict = intersection_verdict(run);
  if (!verdict) return "";
  return "<p class=\"outcome " + std::string(verdict->intersection_free ? "good" : "poor") + "\">" +
         escape(verdict->text) + "</p>\n";
}

std::string load_stepping_section(const RunData& run) {
  return run.increments.empty() ? "" : std::string(Embedded::load_stepping_html());
}

std::string machine_line(const RunData& run) {
  std::string text;
  if (!run.version.empty()) text += escape(run.version);
  if (!run.cpu.empty()) text += (text.empty() ? "" : " · ") + escape(run.cpu);
  if (run.cores) text += " · " + html::count(run.cores) + " cores";
  if (run.threads) text += " · " + html::count(run.threads) + (*run.threads == 1 ? " thread" : " threads");
  return text;
}

std::string reference_sentence(const RunData& run) {
  if (run.errors.empty()) return "No states were recorded in this run (<code>snapshots: 0</code>).";
  if (run.reference.empty()) return "This run has no reference (<code>reference</code> in the experiment).";
  if (run.reference_is_file) return "The reference is the file <code>" + escape(run.reference) + "</code>.";
  std::string text = "The reference is <b>" + escape(run.reference) + "</b>'s finest state";
  if (run.reference_is_lowest) text += ", the lowest in energy of all that have converged";
  if (run.reference_tolerance)
    text += ", solved on to a force residual of " + number_text(run.reference_tolerance);
  return text + ".";
}

std::string notes(const PictureSet& set) {
  if (set.notes.empty()) return "";
  std::string text = "<details><summary>Not drawn</summary><ul>\n";
  for (const std::string& note : set.notes) text += "<li>" + escape(note) + "</li>\n";
  return text + "</ul></details>\n";
}

}  // namespace

std::vector<std::string> write_report(const std::filesystem::path& run_directory,
                                      const std::function<bool()>& cancelled,
                                      std::optional<int> picture_width) {
  const RunData run = read_run(run_directory);
  PictureSet set = draw_pictures(run, cancelled, picture_width);
  const Gallery gallery(set);
  const ReportView view = report_view(run);
  for (const std::string& note : view.notes)
    if (std::find(set.notes.begin(), set.notes.end(), note) == set.notes.end()) set.notes.push_back(note);
  const std::string page =
      html::fill(Embedded::page_html(),
                 {{"style", std::string(Embedded::page_css()) + std::string(Embedded::viewer_css())},
                  {"title", escape(run.experiment.empty() ? "Unnamed experiment" : run.experiment)},
                  {"description", escape(run.description)},
                  {"machine", machine_line(run)},
                  {"outcome", outcome_sentence(run)},
                  {"verdict", verdict_line(run)},
                  {"summary", summary_table(run)},
                  {"troubles", troubles(run)},
                  {"levels", level_table(run)},
                  {"states", state_grid(run, gallery) + outline_grid(run, gallery)},
                  {"notes", notes(set)},
                  {"view", view.section},
                  {"view_scripts", view.scripts},
                  {"state_metrics", metric_texts(run, MetricScope::state)},
                  {"pair_metrics", metric_texts(run, MetricScope::pair)},
                  {"consistency", consistency_table(run)},
                  {"metric_pictures", metric_pictures(run, gallery, set)},
                  {"load_stepping", load_stepping_section(run)},
                  {"configuration",
                   run.configuration.empty() ? "config.yaml was not stored." : escape(run.configuration)},
                  {"data", chart_data(run)},
                  {"chart_library", std::string(Embedded::chart_js())},
                  {"reference", reference_sentence(run)},
                  {"charts", std::string(Embedded::charts_js())},
                  {"script", std::string(Embedded::page_js())}});
  write_file(run_directory / "report.html", page);
  return set.notes;
}

}  // namespace drape
