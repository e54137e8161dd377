// How numbers and texts of users and files appear in messages, and what is read of files at all.

#include "core/kernel/files/message_text.h"

#include <sys/stat.h>

#include <catch2/catch.hpp>
#include <cstdio>
#include <limits>
#include <new>

#include "core/app/files/yaml_file.h"
#include "core/kernel/files/file.h"
#include "core/kernel/files/number_text.h"
#include "core/kernel/files/string_utils.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/command.h"

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

TEST_CASE("a quantity is shown with three digits, whatever its size") {
  CHECK(three_digits(1234.5) == "1.23e+03");
  CHECK(three_digits(0.125) == "0.125");
  CHECK(three_digits(2) == "2");
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
}

TEST_CASE("a text is split at every separator") {
  using Parts = std::vector<std::string>;
  CHECK(split("obstacles.0.center", '.') == Parts{"obstacles", "0", "center"});
  CHECK(split("a,,b,", ',') == Parts{"a", "", "b", ""});
  CHECK(split("", ',') == Parts{""});
}

TEST_CASE("columns are padded by characters, not by bytes") {
  CHECK(display_width("") == 0);
  CHECK(display_width("kg/m³ µ") == 7);
  CHECK(padded("m²", 4) == "m²  ");
  CHECK(padded("m²", 2) == "m²");
  CHECK(padded("µm/m²", 3) == "µm/m²");
}

TEST_CASE("a long text keeps its beginning and its end, cut between characters") {
  const std::string text = "begin" + std::string(3000000, 'x') + "end";
  CHECK(excerpt(text).size() < 150);
  CHECK(excerpt(text).starts_with("beginxxx"));
  CHECK(excerpt(text).ends_with("xxxend"));
  CHECK(excerpt(text).find("2999918 bytes left out") != std::string::npos);
  for (int shift = 0; shift < 3; ++shift) {
    std::string euros(shift, 'x');
    for (int k = 0; k < 100; ++k) euros += "€";
    CHECK(excerpt(euros).find("\\x") == std::string::npos);
  }
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
  CHECK(reason([] {
          (void)fs::is_directory(std::string(5000, 'x'));
        }).ends_with("x: File name too long; shorten the name"));
  CHECK(reason([] { throw std::bad_alloc(); }) == no_memory);
  CHECK(reason([] { std::vector<int>().reserve(std::size_t(-1)); }) == no_memory);
  CHECK(reason([] { throw std::runtime_error("as it is"); }) == "as it is");
}

TEST_CASE("only regular files of limited size are read, without blocking") {
  const Scratch folder;
  REQUIRE(mkfifo((folder / "pipe").c_str(), 0600) == 0);
  fs::create_directory(folder / "sub");
  folder.write("small", "12345678");
  const std::string in = folder.path.string() + "/";
  CHECK(read_file(folder / "small") == "12345678");
  CHECK(read_file(folder / "small", 8).size() == 8);
  CHECK_THROWS_WITH(read_file(folder / "small", 7),
                    in + "small: is larger than 0 MB, the most that is read of it");
  CHECK_THROWS_WITH(read_file(folder / "pipe"), in + "pipe: is a pipe or a device; give a file on a disk");
  CHECK_THROWS_WITH(read_file("/dev/zero"), "/dev/zero: is a pipe or a device; give a file on a disk");
  CHECK_THROWS_WITH(read_file(folder / "sub"), in + "sub: is a folder, not a file");
  CHECK_THROWS_WITH(read_file(folder / "none"), "cannot read " + in + "none: No such file or directory");
  CHECK_THROWS_WITH(read_file("a\0b"s), Catch::Contains("has a NUL character in its name"));
  fs::resize_file(folder / "small", largest_file + 1);  // takes no place on the disk
  CHECK_THROWS_WITH(read_file(folder / "small"),
                    in + "small: is larger than 2000 MB, the most that is read of it");
  CHECK(read_file("/proc/self/cmdline").size() > 0);  // says that it has no bytes
  for (const char* extension : {".obj", ".off", ".ply"}) {
    REQUIRE(mkfifo((folder / ("mesh"s + extension)).c_str(), 0600) == 0);
    CHECK_THROWS_WITH(read_mesh(folder / ("mesh"s + extension)), Catch::Contains("is a pipe or a device"));
  }
}

TEST_CASE(
    "a config is text: bytes at which YAML would end, or that are no UTF-8, are refused with their place") {
  const auto fault = [](const std::string& text) {
    ConfigErrors errors;
    CHECK(parse_yaml(text, "f", errors).kind == ConfigNode::Kind::null);
    REQUIRE(errors.size() == 1);
    return errors[0].text();
  };
  CHECK(fault("a: 1\nb: 2\0c: 3\n"s) == "f:2:5: has the byte \\x00, which is no text in UTF-8");
  CHECK(fault("a: 1\n\x04") == "f:2:1: has the byte \\x04, which is no text in UTF-8");
  CHECK(fault("\x1b: 1\n") == "f:1:1: has the byte \\x1b, which is no text in UTF-8");
  CHECK(fault("a: \xff\n") == "f:1:4: has the byte \\xff, which is no text in UTF-8");
  CHECK(fault("a: \"x\\0y\"\n") == "f:1:4: \"x\\x00y\" has a NUL character; take it out");
  CHECK(fault("\"x\\0y\": 1\n") == "f:1:1: \"x\\x00y\" has a NUL character; take it out");
  ConfigErrors none;
  CHECK(parse_yaml("a: \"\\e[0m ü\"\r\n\tb: é\n", "f", none).kind ==
        ConfigNode::Kind::null);  // tabs do not indent
  CHECK(parse_yaml("a: \"\\e[0m\"\r\nb: é\n", "f", none).find("b")->scalar == "é");
}

TEST_CASE("a word of a megabyte is not compared letter by letter") {
  CHECK(nearest_word(std::string(20000000, 'x'), {"levels", std::string(200, 'x')}).empty());
}
