#pragma once

#include <string>
#include <vector>

namespace drape {

/// The word closest to `typed`, or "" if none is close; ignores case and treats - as _.
std::string nearest_word(const std::string& typed, const std::vector<std::string>& words);

/// `did you mean "word"?` by nearest_word, or `otherwise` if no word is close.
std::string did_you_mean(const std::string& typed, const std::vector<std::string>& words,
                         const std::string& otherwise);

/// The only word that contains `part`, of three letters or more, or "" without one or with several; ignores
/// case and treats - as _.
std::string only_word_with(const std::string& part, const std::vector<std::string>& words);

/// Whether the word is one of them.
bool is_one_of(const std::string& word, const std::vector<std::string>& words);

/// Appends the word, unless it is one of them.
void add_new(std::vector<std::string>& words, const std::string& word);

/// The parts between separators; empty ones too, so one more than there are separators.
std::vector<std::string> split(const std::string& text, char separator);

/// "a, b, c", or with other separators, as in "a, b and c".
std::string joined(const std::vector<std::string>& words, const char* separator = ", ",
                   const char* last = ", ");

/// The first `most` words, then how many more there are.
std::vector<std::string> first_of(const std::vector<std::string>& words, std::size_t most);

/// "a, b, c" for a message: excerpts of the first forty words, then how many more there are.
std::string listed(const std::vector<std::string>& words);

/// `"a", "b" or "c"`
std::string quoted_choice(const std::vector<std::string>& words);

/// The text as one word of a shell's command, in single quotes.
std::string shell_quoted(const std::string& text);

/// Columns that UTF-8 text takes on a terminal: its code points, as of "m²".
std::size_t display_width(const std::string& text);

/// The text with as many spaces behind it as make it `width` columns wide; a wider one stays as it is.
std::string padded(const std::string& text, std::size_t width);

/// Rows of equally many cells for a terminal, each a line, in columns two spaces apart; at least one row.
std::string text_table(const std::vector<std::vector<std::string>>& rows);

}  // namespace drape
