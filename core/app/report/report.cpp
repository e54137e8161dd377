#include "core/app/report/report.h"

#include "core/app/report/chart_data.h"
#include "core/app/report/pictures.h"
#include "core/app/report/report_view.h"
#include "core/app/report/tables.h"
#include "core/app/view/embedded.h"
#include "core/app/view/html.h"
#include "core/kernel/mesh/file.h"

namespace drape {

namespace {

using html::escape;
using html::number_text;

constexpr std::size_t most_picture_bytes =
    11'000'000;  // as PNG; a third more in the page, beside the 3D data

/// Pictures as data URLs, at half size when all of them would make the page too large.
class Gallery {
 public:
  explicit Gallery(const PictureSet& set) : set_(set) {
    std::size_t bytes = 0;
    for (const auto& [name, picture] : set.pictures) bytes += picture.png.size();
    halve_ = bytes > most_picture_bytes;
  }

  std::string shown(const std::string& name, const std::string& alt, const std::string& caption) const {
    const Picture* picture = set_.find(name);
    if (!picture)
      return "<figure class=\"absent\"><p>no picture</p><figcaption>" + caption + "</figcaption></figure>\n";
    const Image& full = picture->image;
    const Image half = halve_ ? shrink(full, 2) : Image();
    const std::string data = html::base64(halve_ ? encode_png(half) : picture->png);
    return "<figure><img width=\"" + std::to_string(halve_ ? half.width : full.width) + "\" height=\"" +
           std::to_string(halve_ ? half.height : full.height) + "\" alt=\"" + escape(alt) +
           "\" src=\"data:image/png;base64," + data + "\"><figcaption>" + caption +
           "</figcaption></figure>\n";
  }

 private:
  const PictureSet& set_;
  bool halve_ = false;
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

std::string state_grid(const RunData& run, const Gallery& gallery) {
  std::string text = grid_open(run.methods.size()) + grid_head(run);
  for (const int level : run.level_indices()) {
    for (const MethodRecord& method : run.methods) {
      const LevelRecord* r = method.level(level);
      const std::string caption =
          label(method, level) + ": " + html::count(r ? r->vertices : OptionalNumber()) + " vertices, " +
          number_text(r ? r->energy_on_finest : OptionalNumber()) + "&nbsp;J on finest";
      text += gallery.shown(state_picture(method, level),
                            method.name + ": the cloth at level " + std::to_string(level), caption);
    }
  }
  return text + "</div>\n";
}

std::string H_difference_grid(const RunData& run, const Gallery& gallery, const PictureSet& set) {
  if (!(set.H_difference_scale > 0)) {
    return "<p class=\"absent\">No curvature differences were stored in this run.</p>";
  }
  const std::string end = number_text(set.H_difference_scale);
  std::string text = "<p class=\"legend\"><span>−" + end + "</span><i class=\"diverging\"></i><span>+" + end +
                     " 1/m</span></p>\n" + grid_open(run.methods.size());
  for (const MethodRecord& method : run.methods) {
    const ConsistencyRecord* pair = widest_pair(method);
    const std::string levels =
        pair ? "level " + std::to_string(pair->coarse) + " to " + std::to_string(pair->fine) : "no pair";
    const std::string name = pair ? H_difference_picture(method, *pair) : "";
    text += gallery.shown(
        name, method.name + ": difference in mean curvature, " + levels,
        "<b>" + escape(method.name) + "</b>, " + levels +
            ": d<sub>H</sub><sup>fit</sup> = " + number_text(pair ? pair->d_H_fit : OptionalNumber()));
  }
  return text + "</div>\n";
}

std::string fold_grid(const RunData& run, const Gallery& gallery, const PictureSet& set) {
  if (!(set.fold_threshold > 0)) {
    return "<p class=\"absent\">No principal curvatures were stored in this run.</p>";
  }
  const std::string threshold = number_text(set.fold_threshold);
  std::string text = "<p class=\"legend\"><i class=\"below\"></i><span>below −" + threshold +
                     "</span><i class=\"flat\"></i><span>between</span><i class=\"above\"></i><span>above +" +
                     threshold + " 1/m</span></p>\n" + grid_open(run.methods.size()) + grid_head(run);
  for (const int level : run.level_indices()) {
    for (const MethodRecord& method : run.methods) {
      text += gallery.shown(fold_picture(method, level),
                            method.name + ": folds at level " + std::to_string(level), label(method, level));
    }
  }
  return text + "</div>\n";
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

/// Caveats beside the paper's columns.
constexpr const char* of_libigl =
    "Its d<sub>K</sub><sup>fit</sup> may be of libigl's Gaussian curvature, which is not quite the fitted "
    "quadric's.";

std::string published_section(const RunData& run) {
  if (table1_block(run.table1_scene)) {
    return "<p>The paper's columns are “" + escape(run.table1_scene) +
           "” of its Table 1. It states neither " +
           "units (lengths are taken as metres) nor the scene's geometry: compare ratios between methods, "
           "not " +
           "figures. " + of_libigl + "</p>\n";
  }
  const Table1Block& reference = *table1_block("Drape over Sphere in Figure 6");
  return "<h3>For orientation: the paper's “" + reference.scene +
         "”</h3>\n<p>From Table 1 of the supplement, " +
         "another scene than this one. It states no units (lengths are taken as metres): compare ratios " +
         "between methods, not figures. " + of_libigl + "</p>\n" + published_table(reference);
}

std::string reference_sentence(const RunData& run) {
  if (run.errors.empty()) return "No states were recorded in this run (<code>snapshots: 0</code>).";
  if (run.reference.empty()) return "This run has no reference (<code>reference</code> in the experiment).";
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

void write_report(const std::filesystem::path& run_directory, const std::function<bool()>& leave) {
  const RunData run = read_run(run_directory);
  PictureSet set = draw_pictures(run, leave);
  const Gallery gallery(set);
  const ReportView view = report_view(run);
  set.notes.insert(set.notes.end(), view.notes.begin(), view.notes.end());
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
                  {"states", state_grid(run, gallery)},
                  {"notes", notes(set)},
                  {"view", view.section},
                  {"view_scripts", view.scripts},
                  {"consistency", consistency_table(run, table1_block(run.table1_scene))},
                  {"published", published_section(run)},
                  {"H_surface", set.maps_on_rest ? "the flat rest shape" : "the finer state"},
                  {"H_quantile", html::count(100 * H_difference_quantile)},
                  {"H_differences", H_difference_grid(run, gallery, set)},
                  {"fold_quantile", html::count(100 * fold_quantile)},
                  {"folds", fold_grid(run, gallery, set)},
                  {"load_stepping", load_stepping_section(run)},
                  {"energies", energy_table(run)},
                  {"configuration",
                   run.configuration.empty() ? "config.yaml was not stored." : escape(run.configuration)},
                  {"data", chart_data(run)},
                  {"chart_library", std::string(Embedded::chart_js())},
                  {"reference", reference_sentence(run)},
                  {"charts", std::string(Embedded::charts_js())},
                  {"script", std::string(Embedded::page_js())}});
  write_file(run_directory / "report.html", page);
}

}  // namespace drape
