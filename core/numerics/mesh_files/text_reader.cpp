#include "core/numerics/mesh_files/text_reader.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "core/kernel/files/file.h"
#include "core/kernel/files/message_text.h"
#include "core/kernel/files/number_text.h"

namespace drape {
namespace {

constexpr std::string_view white_space = " \t\r\n\v\f";

std::string in_quotes(std::string_view word) { return "'" + excerpt(word) + "'"; }

}  // namespace

std::string_view utf8_text(const std::filesystem::path& path, std::string_view bytes) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  constexpr std::string_view wide_marks[] = {"\xFF\xFE", "\xFE\xFF", {"\0\0\xFE\xFF", 4}};
  const auto is_zero = [&](std::size_t i) { return bytes[i] == '\0'; };
  if (std::ranges::any_of(wide_marks, [&](std::string_view wide) { return bytes.starts_with(wide); }) ||
      (bytes.size() >= 4 && is_zero(0) != is_zero(1) && is_zero(0) == is_zero(2) && is_zero(1) == is_zero(3)))
    refuse_path(path, "is in UTF-16 or UTF-32; save it as UTF-8");
  return bytes.substr(bytes.starts_with(mark) ? mark.size() : 0);
}

TextReader::TextReader(std::filesystem::path path, std::string_view text, char comment, char continuation)
    : path_(std::move(path)), text_(text), comment_(comment), continuation_(continuation) {
  if (const std::size_t first = text.find_first_of("\r\n");
      first != text.npos && text[first] == '\r' && !text.substr(first + 1).starts_with('\n'))
    line_end_ = '\r';
  position_ = text_.size() - utf8_text(path_, text_).size();
}

bool TextReader::next_line() {
  words_.clear();
  next_ = 0;
  for (bool goes_on = false; (words_.empty() || goes_on) && position_ < text_.size();) {
    const std::size_t end = std::min(text_.find(line_end_, position_), text_.size());
    std::string_view line = text_.substr(position_, end - position_);
    position_ = std::min(end + 1, text_.size());
    ++line_;
    if (comment_ != '\0') line = line.substr(0, line.find(comment_));
    for (std::size_t begin = line.find_first_not_of(white_space); begin != line.npos;) {
      const std::size_t stop = std::min(line.find_first_of(white_space, begin), line.size());
      words_.push_back(line.substr(begin, stop - begin));
      begin = line.find_first_not_of(white_space, stop);
    }
    goes_on = continuation_ != '\0' && !words_.empty() && words_.back().ends_with(continuation_);
    if (!goes_on) continue;
    words_.back().remove_suffix(1);
    if (words_.back().empty()) words_.pop_back();
  }
  return !words_.empty();
}

std::string_view TextReader::next_word(const std::string& expected) {
  if (next_ == words_.size() && !next_line()) fail("the file ends where " + expected + " is expected");
  return words_[next_++];
}

double TextReader::number(std::string_view word) const {
  double value = 0;
  const std::errc error = read_number(word, value);
  if (error == std::errc::result_out_of_range)
    fail(in_quotes(word) + " is too large or too small for a 64-bit number");
  if (error != std::errc()) fail(in_quotes(word) + " is not a number");
  return value;
}

double TextReader::coordinate(std::string_view word) const {
  const double value = number(word);
  if (!std::isfinite(value)) fail(in_quotes(word) + " is not a finite coordinate");
  return value;
}

long long TextReader::integer(std::string_view word) const {
  long long value = 0;
  if (read_number(word, value) != std::errc()) fail(in_quotes(word) + " is not an integer");
  return value;
}

int TextReader::vertex(std::string_view word, int vertex_count) const {
  const long long value = integer(word);
  if (value < 0 || value >= vertex_count)
    fail("vertex " + std::to_string(value) + " is not in 0 … " + std::to_string(vertex_count - 1));
  return static_cast<int>(value);
}

int TextReader::count(std::string_view word, const std::string& things) const {
  const long long value = integer(word);
  if (value < 0 || value > static_cast<long long>(text_.size()) || value > std::numeric_limits<int>::max())
    fail("the file has no room for " + std::to_string(value) + " " + things);
  return static_cast<int>(value);
}

void TextReader::fail(const std::string& message) const {
  if (text_.empty()) refuse_path(path_, "is empty");
  throw std::runtime_error(path_.string() + ":" + std::to_string(line_) + ": " + message + note());
}

}  // namespace drape
