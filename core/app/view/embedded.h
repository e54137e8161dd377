#pragma once

#include <string_view>

namespace drape {

/// Files built into the library (core/app/view/assets, Chart.js and three.js), as text.
struct Embedded {
  static std::string_view page_html();
  static std::string_view page_css();
  static std::string_view page_js();
  static std::string_view load_stepping_html();
  static std::string_view charts_js();
  static std::string_view runs_html();
  static std::string_view runs_js();
  static std::string_view chart_js();
  static std::string_view three_js();
  static std::string_view viewer_html();
  static std::string_view viewer_css();
  static std::string_view viewer_data_js();
  static std::string_view viewer_scene_js();
  static std::string_view viewer_controls_js();
  static std::string_view viewer_js();
  static std::string_view live_html();
  static std::string_view live_js();
};

}  // namespace drape
