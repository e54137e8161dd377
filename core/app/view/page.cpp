#include "core/app/view/page.h"

#include <algorithm>
#include <cctype>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <string_view>

#include "core/app/files/json_file.h"

// The assembler includes the files as they are, from the source and build folders and from where the system's
// packages have put them.
#ifndef DRAPE_PAGE_JS
#error "define DRAPE_PAGE_JS as the quoted path of the page's script (core/CMakeLists.txt)"
#endif
#ifndef DRAPE_THREE_JS
#error "define DRAPE_THREE_JS as the quoted path of three.min.js (Debian: libjs-three)"
#endif

#define DRAPE_EMBED(name, path)                                                                     \
  __asm__(".pushsection .rodata; .local drape_" #name ", drape_" #name "_end; drape_" #name         \
          ":; "                                                                                     \
          ".incbin \"" path "\"; drape_" #name "_end:; .byte 0; .popsection");                      \
  extern "C" __attribute__((visibility("hidden"))) const char drape_##name[], drape_##name##_end[]; \
  static std::string_view name() { return {drape_##name, drape_##name##_end}; }

DRAPE_EMBED(page_html, "viewer/page.html")
DRAPE_EMBED(page_css, "viewer/page.css")
DRAPE_EMBED(page_js, DRAPE_PAGE_JS)
DRAPE_EMBED(three_js, DRAPE_THREE_JS)

namespace drape {

namespace {

std::string replaced_all(std::string text, std::string_view what, std::string_view by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size())
    text.replace(at, what.size(), by);
  return text;
}

}  // namespace

std::string page(const std::string& title, const nlohmann::ordered_json& data, const std::string& blocks) {
  const std::string safe_title = replaced_all(replaced_all(title, "&", "&amp;"), "<", "&lt;");
  const std::string json = replaced_all(ascii_json_text(data), "<", "\\u003c");
  const std::map<std::string_view, std::string_view> values = {{"title", safe_title}, {"style", page_css()},
                                                               {"data", json},        {"blocks", blocks},
                                                               {"three", three_js()}, {"script", page_js()}};
  const std::string_view form = page_html();
  std::string text;
  for (std::size_t place = 0;;) {
    const std::size_t open = form.find("{{", place);
    text += form.substr(place, open - place);
    if (open == std::string_view::npos) return text;
    const std::size_t close = form.find("}}", open);
    text += values.at(form.substr(open + 2, close - open - 2));
    place = close + 2;
  }
}

int solver_style(std::string_view solver) {
  constexpr std::string_view styled[] = {"pcs", "cascadic", "newton"};
  return static_cast<int>(std::find(std::begin(styled), std::end(styled), solver) - std::begin(styled));
}

std::string url_path(const std::filesystem::path& path) {
  static const char digits[] = "0123456789ABCDEF";
  std::string link;
  for (const char c : path.generic_string()) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < 0x80 && (std::isalnum(byte) || std::string_view("/._-~=").find(c) != std::string_view::npos))
      link += c;
    else
      link += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return link;
}

}  // namespace drape
