#include "core/app/view/embedded.h"

// The assembler looks for relative names in the compiler's include folders, so the project's own files
// need only the include root; Chart.js and three.js lie where the system's packages have put them.
#ifndef DRAPE_CHART_JS
#error "define DRAPE_CHART_JS as the quoted path of chart.min.js (Debian: libjs-chart.js)"
#endif
#ifndef DRAPE_THREE_JS
#error "define DRAPE_THREE_JS as the quoted path of three.min.js (Debian: libjs-three)"
#endif

#define DRAPE_EMBED(name, path)                                                              \
  __asm__(                                                                                   \
      ".pushsection .rodata\n"                                                               \
      ".local drape_embedded_" #name                                                         \
      "\n"                                                                                   \
      ".local drape_embedded_" #name                                                         \
      "_end\n"                                                                               \
      "drape_embedded_" #name                                                                \
      ":\n"                                                                                  \
      ".incbin \"" path                                                                      \
      "\"\n"                                                                                 \
      "drape_embedded_" #name                                                                \
      "_end:\n"                                                                              \
      ".byte 0\n"                                                                            \
      ".popsection\n");                                                                      \
  extern "C" __attribute__((visibility("hidden"))) const char drape_embedded_##name[];       \
  extern "C" __attribute__((visibility("hidden"))) const char drape_embedded_##name##_end[]; \
  std::string_view drape::Embedded::name() {                                                 \
    return {drape_embedded_##name,                                                           \
            static_cast<std::size_t>(drape_embedded_##name##_end - drape_embedded_##name)};  \
  }

DRAPE_EMBED(page_html, "core/app/view/assets/page.html")
DRAPE_EMBED(page_css, "core/app/view/assets/page.css")
DRAPE_EMBED(page_js, "core/app/view/assets/page.js")
DRAPE_EMBED(load_stepping_html, "core/app/view/assets/load_stepping.html")
DRAPE_EMBED(charts_js, "core/app/view/assets/charts.js")
DRAPE_EMBED(runs_html, "core/app/view/assets/runs.html")
DRAPE_EMBED(runs_js, "core/app/view/assets/runs.js")
DRAPE_EMBED(chart_js, DRAPE_CHART_JS)
DRAPE_EMBED(three_js, DRAPE_THREE_JS)
DRAPE_EMBED(viewer_html, "core/app/view/assets/viewer.html")
DRAPE_EMBED(viewer_css, "core/app/view/assets/viewer.css")
DRAPE_EMBED(viewer_data_js, "core/app/view/assets/viewer_data.js")
DRAPE_EMBED(viewer_scene_js, "core/app/view/assets/viewer_scene.js")
DRAPE_EMBED(viewer_controls_js, "core/app/view/assets/viewer_controls.js")
DRAPE_EMBED(viewer_js, "core/app/view/assets/viewer.js")
DRAPE_EMBED(live_html, "core/app/view/assets/live.html")
DRAPE_EMBED(live_js, "core/app/view/assets/live.js")
