#pragma once

#include <exception>
#include <stdexcept>
#include <string>
#include <string_view>

namespace drape {

/// A text from a user or a file, safe for a one-line message: control characters, bidirectional controls and
/// bytes that are not UTF-8 appear as `\xNN`. A long text loses its middle.
std::string printable(std::string_view text, std::size_t most_bytes = 2000);

/// A text of several lines, each safe for a message.
std::string printable_lines(std::string_view text);

/// The index of the first byte that is not UTF-8, or a control character but tabs and line ends; or npos.
std::size_t first_unprintable(std::string_view text);

/// As printable, for a word within a message.
std::string excerpt(std::string_view text);

/// A quantity to three significant digits.
std::string three_digits(double value);

/// An exception as a sentence: file system errors name the file, lack of memory suggests a remedy.
std::string reason_of(const std::exception& error);

/// The exception that is being handled as a sentence, whatever it is: plugins throw anything.
std::string message_in_flight();

/// What `call` returns. The message of a runtime_error that it throws, and of what is not a std::exception,
/// begins with `name`, such as "energy hinge", or with the name's last words; others (memory, Python) pass.
template <class Call>
auto with_name(const std::string& name, const Call& call) {
  try {
    return call();
  } catch (const std::runtime_error& error) {
    const std::string message = error.what();
    const bool named = message.starts_with(name.substr(name.find(' ') + 1));
    throw std::runtime_error(named ? message : name + ": " + message);
  } catch (const std::exception&) {
    throw;
  } catch (...) {
    throw std::runtime_error(name + ": " + message_in_flight());
  }
}

}  // namespace drape
