#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace drape {

/// A text file's bytes without a byte order mark. Throws std::runtime_error naming the file if it is in
/// UTF-16 or UTF-32, as its mark or every other byte says.
std::string_view utf8_text(const std::filesystem::path& path, std::string_view bytes);

/// A text as lines of words, with errors that name file and line. Lines end with LF, CRLF or CR, whichever
/// ends the first. The text must outlive the reader.
class TextReader {
 public:
  /// `comment` starts a comment that runs to the end of its line, and `continuation` at the end of a line
  /// joins the next one to it; '\0' for none.
  TextReader(std::filesystem::path path, std::string_view text, char comment, char continuation = '\0');

  /// Moves to the next line that has words; false at the end of the text.
  bool next_line();
  /// Words of the current line.
  const std::vector<std::string_view>& words() const { return words_; }
  /// The next word, on this line or a later one; the error at the end of the text names what was `expected`.
  std::string_view next_word(const std::string& expected);
  /// Whether next_word has further words of this line.
  bool has_words_left() const { return next_ < words_.size(); }
  /// Skips the remaining words of this line.
  void finish_line() { next_ = words_.size(); }
  /// Bytes up to the end of this line.
  std::size_t position() const { return position_; }

  double number(std::string_view word) const;
  double coordinate(std::string_view word) const;  ///< a number that is finite
  long long integer(std::string_view word) const;
  /// integer(word), a vertex, which must lie in 0 … vertex_count - 1.
  int vertex(std::string_view word, int vertex_count) const;

  /// integer(word), a number of `things`, each of which takes at least a byte of the text.
  int count(std::string_view word, const std::string& things) const;

  /// A note in parentheses at the end of every further error.
  void set_note(std::string note) { note_ = std::move(note); }
  /// The note in parentheses; empty without one.
  std::string note() const { return note_.empty() ? "" : " (" + note_ + ")"; }

  [[noreturn]] void fail(const std::string& message) const;  ///< std::runtime_error "file:line: message"

 private:
  std::filesystem::path path_;
  std::string_view text_;
  char comment_, continuation_;
  char line_end_ = '\n';
  std::size_t position_ = 0;
  int line_ = 0;
  std::vector<std::string_view> words_;
  std::size_t next_ = 0;
  std::string note_;
};

}  // namespace drape
