// Tables that copy figures from a record say which, in a comment above: <!-- record: FILE … -->. Every number
// of such a table stands in its record, to the digits that the table has.

#include <catch2/catch.hpp>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <sstream>
#include <string>

#include "tests/support/pages.h"

namespace fs = std::filesystem;

namespace {

struct Number {
  double value, half_digit;  ///< half a unit of the last digit written
};

/// The numbers of a text; words with letters in them, as 98K, are none.
std::vector<Number> numbers_of(const std::string& text) {
  std::vector<Number> numbers;
  const auto part = [](unsigned char c) {
    return std::isalnum(c) || c == '.' || c == '-' || c == '+' || c == '_' || c >= 0x80;
  };
  for (std::size_t i = 0; i < text.size();) {
    std::size_t end = i;
    while (end < text.size() && part(text[end])) ++end;
    std::string word = text.substr(i, end - i);
    i = end + 1;
    while (word.ends_with('.')) word.pop_back();
    if (word.starts_with('+')) word.erase(0, 1);
    double value = 0;
    const auto [rest, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (word.empty() || error != std::errc() || rest != word.data() + word.size()) continue;
    const std::size_t exponent = word.find_first_of("eE"), point = word.find('.');
    double digit = exponent == word.npos ? 1 : std::pow(10, std::stoi(word.substr(exponent + 1)));
    if (point != word.npos) digit *= std::pow(10, -double(std::min(exponent, word.size()) - point - 1));
    numbers.push_back({value, 0.5 * digit});
  }
  return numbers;
}

bool stands_in(const Number& number, const std::vector<Number>& record) {
  for (const Number& recorded : record)
    if (std::abs(number.value - recorded.value) <=
        1.001 * std::max(number.half_digit, 1e-12 * std::abs(number.value)))
      return true;
  return false;
}

std::string first_cell(const std::string& row) {
  const std::size_t end = row.find('|', 1);
  return end == row.npos ? "" : row.substr(1, end - 1);
}

/// A record's numbers for a table's row: of Markdown, the rows that begin alike; of anything else, all.
std::vector<Number> recorded(const std::vector<fs::path>& records, const std::string& row) {
  std::string text;
  for (const fs::path& record : records)
    if (record.extension() == ".md") {
      for (const std::string& line : pages::lines_of(record))
        if (line.starts_with("|") && first_cell(line) == first_cell(row)) text += line + "\n";
    } else {
      text += pages::text_of(record);
    }
  return numbers_of(text);
}

}  // namespace

TEST_CASE("every figure of a table stands in the record that the table names") {
  const fs::path root = folders::source();
  int tables = 0, figures = 0;
  for (const fs::path& page : pages::documents()) {
    std::vector<fs::path> records;
    int row = 0;
    for (const std::string& line : pages::lines_of(page)) {
      if (line.starts_with("<!-- record: ")) {
        std::istringstream names(line.substr(13, line.find(" -->") - 13));
        records.clear();
        for (std::string name; names >> name;) {
          INFO(page.string() << " names " << name);
          REQUIRE(fs::exists(root / name));
          records.push_back(root / name);
        }
        row = 0;
        ++tables;
      } else if (line.empty()) {
        records.clear();
      } else if (!records.empty() && ++row > 2) {  // below the table's head
        const std::vector<Number> record = recorded(records, line);
        // The first cell names the row.
        for (const Number& number : numbers_of(line.substr(first_cell(line).size() + 2))) {
          INFO(page.string() << ": " << number.value << " in " << line);
          CHECK(stands_in(number, record));
          ++figures;
        }
      }
    }
  }
  CHECK(tables >= 8);
  CHECK(figures > 200);
}
