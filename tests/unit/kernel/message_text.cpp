// How numbers and texts of users and files appear in messages, and what is read of files at all.

#include "core/kernel/files/message_text.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <limits>
#include <new>

#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"
#include "tests/unit/kernel/config_faults.h"

using namespace drape;
using namespace std::string_literals;
namespace fs = std::filesystem;

TEST_CASE("control characters and bytes that are no UTF-8 are shown escaped, other text as it is") {
  CHECK(printable("Stoff für 3 µm × 2 – 布") == "Stoff für 3 µm × 2 – 布");
  CHECK(printable("a\0b"s) == "a\\x00b");
  CHECK(printable("\x1b[31mred\x7f\tx\ny") == "\\x1b[31mred\\x7f\\tx\\ny");
  CHECK(printable("\xff\xc3(\xe2\x82") == "\\xff\\xc3(\\xe2\\x82");
  CHECK(printable("\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80") == "\\xc0\\xaf\\xed\\xa0\\x80\\xf4\\x90\\x80\\x80");
  CHECK(printable("\xc2\x9b"s + "2J \xe2\x80\xae") == "\\xc2\\x9b2J \\xe2\\x80\\xae");
  CHECK(printable_lines("a\x01\nb\n") == "a\\x01\nb\n");
}

TEST_CASE("numbers are written as printf writes them in the C locale") {
  const auto printed = [](const char* format, int precision, double value) {
    char text[400];
    std::snprintf(text, sizeof text, format, precision, value);
    return std::string(text);
  };
  using Limits = std::numeric_limits<double>;
  for (const double value : {0.0, -0.0, 0.5, 2.5, 1.0 / 3, -1e-5, 99999.95, 123456789.0, 1e22, -5e-324,
                             Limits::max(), Limits::infinity(), -Limits::infinity(), Limits::quiet_NaN()})
    for (const int precision : {0, 1, 2, 3, 6, 9, 17}) {
      CAPTURE(value, precision);
      CHECK(fixed_text(value, precision) == printed("%.*f", precision, value));
      CHECK(scientific_text(value, precision) == printed("%.*e", precision, value));
      CHECK(general_text(value, precision) == printed("%.*g", precision, value));
    }
  CHECK(three_digits(1234.5) == "1.23e+03");
}

TEST_CASE("a text is split at every separator, and padded by characters, not by bytes") {
  using Parts = std::vector<std::string>;
  CHECK(split("a,,b,", ',') == Parts{"a", "", "b", ""});
  CHECK(split("", ',') == Parts{""});
  CHECK(display_width("kg/m³ µ") == 7);
  CHECK(padded("m²", 4) == "m²  ");
  CHECK(padded("µm/m²", 3) == "µm/m²");
}

TEST_CASE("a long text keeps its beginning and its end, cut between characters") {
  const std::string text = excerpt("begin" + std::string(3000000, 'x') + "end");
  CHECK(text.size() < 150);
  CHECK(text.starts_with("beginxxx"));
  CHECK(text.ends_with("xxxend"));
  CHECK(text.find("2999918 bytes left out") != std::string::npos);
  for (int shift = 0; shift < 3; ++shift) {
    std::string euros(shift, 'x');
    for (int k = 0; k < 100; ++k) euros += "€";
    CHECK(excerpt(euros).find("\\x") == std::string::npos);
  }
  // A word of megabytes is not compared letter by letter.
  CHECK(nearest_word(std::string(20000000, 'x'), {"levels", std::string(200, 'x')}).empty());
}

TEST_CASE("exceptions of the library are sentences that name the file or say what to do") {
  const auto reason = [](const auto& act) -> std::string {
    try {
      act();
    } catch (const std::exception& error) {
      return reason_of(error);
    }
    return "";
  };
  const std::string no_memory = "memory does not suffice; take fewer vertices or levels, or a smaller file";
  CHECK(reason([] { (void)fs::file_size("no/such"); }) ==
        "no/such: No such file or directory; was it moved or removed?");
  CHECK_THAT(reason([] { (void)fs::is_directory(std::string(5000, 'x')); }),
             Catch::EndsWith("x: File name too long; shorten the name"));
  CHECK(reason([] { throw std::bad_alloc(); }) == no_memory);
  CHECK(reason([] { std::vector<int>().reserve(std::size_t(-1)); }) == no_memory);
  CHECK(reason([] { throw std::runtime_error("as it is"); }) == "as it is");
}

TEST_CASE("only regular files of limited size are read, without blocking") {
  const Scratch folder;
  const std::string in = folder.path.string() + "/";
  REQUIRE(mkfifo((in + "pipe").c_str(), 0600) == 0);
  folder.write("small", "12345678");
  CHECK(read_file(folder / "small") == "12345678");
  CHECK(read_file(folder / "small", 8).size() == 8);
  CHECK(read_file("/proc/self/cmdline").size() > 0);  // says that it has no bytes
  const auto check_refused = [](const std::string& file, const std::string& why,
                                std::size_t most = largest_file) {
    CHECK_THROWS_WITH(read_file(file, most), file + ": is " + why);
  };
  check_refused(in + "small", "larger than 0 MB, the most that is read of it", 7);
  for (const std::string& file : {in + "pipe", std::string("/dev/zero")})
    check_refused(file, "a pipe or a device; give a file on a disk");
  check_refused(folder.path.string(), "a folder, not a file");
  CHECK_THROWS_WITH(read_file(folder / "none"), "cannot read " + in + "none: No such file or directory");
  CHECK_THROWS_WITH(read_file("a\0b"s), Catch::Contains("has a NUL character in its name"));
  fs::resize_file(folder / "small", largest_file + 1);  // takes no place on the disk
  check_refused(in + "small", "larger than 2000 MB, the most that is read of it");
  REQUIRE(mkfifo((in + "mesh.obj").c_str(), 0600) == 0);
  CHECK_THROWS_WITH(read_mesh(in + "mesh.obj"), Catch::Contains("is a pipe or a device"));
}

TEST_CASE("bytes at which YAML would end, or that are no UTF-8, are refused with their place") {
  const std::pair<std::string, std::string> bytes[] = {{"a: 1\nb: 2\0c: 3\n"s, "2:5: has the byte \\x00"},
                                                       {"a: 1\n\x04", "2:1: has the byte \\x04"},
                                                       {"\x1b: 1\n", "1:1: has the byte \\x1b"},
                                                       {"a: \xff\n", "1:4: has the byte \\xff"}};
  for (const auto& [yaml, fault] : bytes)
    CHECK(fault_of_yaml(yaml) == "f:" + fault + ", which is no text in UTF-8");
  CHECK(fault_of_yaml("a: \"x\\0y\"\n") == "f:1:4: \"x\\x00y\" has a NUL character; take it out");
  CHECK(fault_of_yaml("\"x\\0y\": 1\n") == "f:1:1: \"x\\x00y\" has a NUL character; take it out");
  CHECK(node_of_yaml("a: \"\\e[0m\"\r\nb: é\n").find("b")->scalar == "é");
}
