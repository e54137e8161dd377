#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace drape {

/// A text of a user or a file as a message may show it, on one line: control characters, characters that turn
/// the direction of writing and bytes that are not UTF-8 appear as \xNN. A longer text loses its middle.
std::string printable(std::string_view text, std::size_t most_bytes = 2000);

/// The same of each of its lines.
std::string printable_lines(std::string_view text);

/// Where a text has its first byte that is not UTF-8, or is a control character other than tabs and ends of
/// lines; npos where it has none.
std::size_t first_unprintable(std::string_view text);

/// The same as printable for a word within a message.
std::string excerpt(std::string_view text);

/// A quantity to three significant digits.
std::string three_digits(double value);

/// An exception as a sentence: errors of the file system name the file, and lack of memory says what to do.
std::string reason_of(const std::exception& error);

}  // namespace drape
