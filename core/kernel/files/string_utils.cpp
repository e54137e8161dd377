#include "core/kernel/files/string_utils.h"

#include <algorithm>
#include <boost/algorithm/string/replace.hpp>
#include <cctype>

#include "core/kernel/files/message_text.h"

namespace drape {
namespace {

std::string folded(std::string word) {
  for (char& c : word) c = c == '-' ? '_' : char(std::tolower(static_cast<unsigned char>(c)));
  return word;
}

/// The optimal string alignment distance: insertions, deletions, substitutions and swaps of neighbours.
size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::vector<size_t>> d(a.size() + 1, std::vector<size_t>(b.size() + 1));
  for (size_t i = 0; i <= a.size(); ++i) d[i][0] = i;
  for (size_t j = 0; j <= b.size(); ++j) d[0][j] = j;
  for (size_t i = 1; i <= a.size(); ++i)
    for (size_t j = 1; j <= b.size(); ++j) {
      d[i][j] = std::min({d[i - 1][j] + 1, d[i][j - 1] + 1, d[i - 1][j - 1] + (a[i - 1] != b[j - 1])});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1])
        d[i][j] = std::min(d[i][j], d[i - 2][j - 2] + 1);
    }
  return d[a.size()][b.size()];
}

}  // namespace

std::string nearest_word(const std::string& typed, const std::vector<std::string>& words) {
  std::string nearest;
  size_t least = std::string::npos, work = 0;
  for (const std::string& word : words) {
    // A third of the letters may be wrong; beyond that a guess only misleads.
    const size_t longer = std::max(typed.size(), word.size()), shorter = std::min(typed.size(), word.size());
    constexpr size_t most_work = 200'000;  // many typed words may each be compared with as many long ones
    if (longer - shorter > longer / 3) continue;
    work += longer * longer;
    if (work > most_work) break;
    const size_t distance = edit_distance(folded(typed), folded(word));
    if (distance > longer / 3 || distance >= least) continue;
    least = distance;
    nearest = word;
  }
  return nearest;
}

std::string did_you_mean(const std::string& typed, const std::vector<std::string>& words,
                         const std::string& otherwise) {
  const std::string nearest = nearest_word(typed, words);
  return nearest.empty() ? otherwise : "did you mean \"" + excerpt(nearest) + "\"?";
}

std::string only_word_with(const std::string& part, const std::vector<std::string>& words) {
  constexpr std::size_t least = 3;  // fewer letters are in a word by chance
  std::string only;
  if (part.size() < least) return only;
  for (const std::string& word : words) {
    if (folded(word).find(folded(part)) == std::string::npos) continue;
    if (!only.empty()) return "";
    only = word;
  }
  return only;
}

bool is_one_of(const std::string& word, const std::vector<std::string>& words) {
  return std::ranges::find(words, word) != words.end();
}

void add_new(std::vector<std::string>& words, const std::string& word) {
  if (!is_one_of(word, words)) words.push_back(word);
}

std::vector<std::string> split(const std::string& text, char separator) {
  std::vector<std::string> parts;
  std::size_t begin = 0;
  for (std::size_t end; (end = text.find(separator, begin)) != std::string::npos; begin = end + 1)
    parts.push_back(text.substr(begin, end - begin));
  parts.push_back(text.substr(begin));
  return parts;
}

std::string joined(const std::vector<std::string>& words, const char* separator, const char* last) {
  std::string text;
  for (std::size_t i = 0; i < words.size(); ++i)
    text += (text.empty() ? "" : i + 1 == words.size() ? last : separator) + words[i];
  return text;
}

std::vector<std::string> first_of(const std::vector<std::string>& words, std::size_t most) {
  if (words.size() <= most) return words;
  std::vector<std::string> first(words.begin(), words.begin() + std::ptrdiff_t(most));
  first.push_back("and " + std::to_string(words.size() - most) + " more");
  return first;
}

std::string listed(const std::vector<std::string>& words) {
  std::vector<std::string> first = first_of(words, 40);
  for (std::string& word : first) word = excerpt(word);
  return joined(first);
}

std::string quoted_choice(const std::vector<std::string>& words) {
  return words.empty() ? "" : "\"" + joined(words, "\", \"", "\" or \"") + "\"";
}

std::string shell_quoted(const std::string& text) {
  return "'" + boost::replace_all_copy(text, "'", "'\\''") + "'";
}

std::size_t display_width(const std::string& text) {
  return std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; });
}

std::string padded(const std::string& text, std::size_t width) {
  return text + std::string(width - std::min(width, display_width(text)), ' ');
}

std::string text_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> widths(rows.front().size(), 0);
  for (const auto& row : rows)
    for (std::size_t k = 0; k < row.size(); ++k) widths[k] = std::max(widths[k], display_width(row[k]));
  std::string text;
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t k = 0; k < row.size(); ++k) line += padded(row[k], widths[k] + 2);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace drape
