#include "core/app/report/viewer_page.h"

#include <stdexcept>

#include "core/app/report/report_view.h"
#include "core/app/view/embedded.h"
#include "core/app/view/html.h"
#include "core/app/view/view_document.h"

namespace drape {

namespace {

std::string page(const std::string& title, const std::string& section, const std::string& scripts) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"color-scheme\" content=\"light dark\">\n<title>" +
         html::escape(title) + " – drape</title>\n<style>\n" + std::string(Embedded::page_css()) +
         std::string(Embedded::viewer_css()) + "</style>\n</head>\n<body>\n<main>\n" + section + "</main>\n" +
         scripts + "</body>\n</html>\n";
}

}  // namespace

std::string viewer_page(const RunData& run) {
  const ReportView view = report_view(run);
  if (view.section.empty())
    throw std::runtime_error(view.notes.empty() ? run.folder.string() + ": the run has no state to show"
                                                : view.notes.front());
  return page(run.experiment, view.section, view.scripts);
}

std::string viewer_page(const std::string& title, const Level& level, const Positions& x,
                        const std::vector<TriangleMesh>& obstacles) {
  std::vector<Level> levels = {level};
  levels.front().index = 0;  // the only one of its document
  std::string blocks;
  ViewDocument document(levels, obstacles, false, [&](const std::string& name, const std::string& bytes) {
    blocks += block_element(name, bytes);
  });
  const SurfaceFields fields = document.fields(0, x);
  document.set_ranges({&fields});
  using Json = ViewDocument::Json;
  const Json state = document.state("state", x, fields);
  const Json entry = {{"level", 0}, {"status", ""}, {"states", Json::array({state})}};
  const Json method = {{"name", title}, {"levels", Json::array({entry})}};
  return page(title, std::string(Embedded::viewer_html()),
              document_element(document.document(title, Json::array({method}))) + blocks + viewer_scripts());
}

}  // namespace drape
