#include <catch2/catch.hpp>

#include "core/app/experiment/cloth.h"
#include "core/app/files/machine.h"
#include "tests/support/command.h"

using namespace drape;

namespace {

/// Of a square of so many columns and rows.
Experiment grid_of(int columns, int levels) {
  Experiment e;
  e.parameters.cloth.columns = e.parameters.cloth.rows = columns;
  e.parameters.levels = levels;
  return e;
}

std::string refusal_of_size(const Experiment& e, LargeMemory large) {
  ConfigErrors errors;
  refuse_too_large(e, large, errors);
  REQUIRE(errors.size() <= 1);
  return errors.empty() ? "" : errors[0].message;
}

}  // namespace

TEST_CASE("A grid has about as many vertices as were asked for, in cells that are about square") {
  ClothParameters c;
  c.shape = "rectangle", c.vertices = 1024, c.triangulation = "criss_cross";
  c.columns = c.rows = 0;
  c.size = {2, 0.5};
  CHECK(grid_counts(c) == Eigen::Vector2i(64, 16));
  c.size = {1e6, 1e-6}, c.columns = 512, c.rows = 2;
  CHECK(grid_counts(c).x() == 512);
}

TEST_CASE("Vertices by level, and memory within what was measured, are known before anything is built") {
  CHECK((estimated_vertices(grid_of(6, 3).parameters) == std::vector<double>{36, 121, 441}));
  ExperimentParameters disc;
  disc.cloth.shape = "disc";
  disc.cloth.vertices = 100;
  disc.levels = 2;
  CHECK((estimated_vertices(disc) == std::vector<double>{100, 400}));
  disc.cloth.shape = "file";
  CHECK(estimated_vertices(disc).empty());
  // Peaks of benchmarks/results: the sphere and the cube on 98K vertices, the bunny's cloth on 187K.
  CHECK(estimated_memory(97969) > 3.34e9);
  CHECK(estimated_memory(97969) < 2 * 2.26e9);
  CHECK(estimated_memory(187489) > 5.06e9);
  CHECK(estimated_memory(6241) > 0.22e9);
  CHECK(estimated_memory(6241) < 0.4e9);
}

TEST_CASE("More vertices than can be counted are refused, with --allow-memory too") {
  CHECK(refusal_of_size(grid_of(12, 10), LargeMemory::allowed) == "");  // 31.7 million vertices: 1.6 TB
  CHECK(refusal_of_size(grid_of(1000, 10), LargeMemory::allowed) ==
        "level 9 would have about 2.6e+11 vertices, more than the 4e+07 that can be counted; take at most 3 "
        "levels");
  // Memory suffices for fewer than can be counted: both are said.
  CHECK_THAT(
      refusal_of_size(grid_of(24, 10), LargeMemory::refused),
      Catch::Matches(".* that can be counted; take at most [1-8] levels, for which this machine's memory "
                     "of [0-9.]+ GB suffices, or up to 9 levels with --allow-memory"));
}

TEST_CASE(
    "A container's memory is what its limit leaves, without the files that the kernel drops on demand") {
  const Scratch group;
  const auto memory = [&] { return ContainerMemory::of(group.path); };
  CHECK(memory().limit > 1e17);
  group.write("memory.max", "max");  // no limit
  CHECK(memory().available > 1e17);
  group.write("memory.max", "4000");
  group.write("memory.current", "3000");
  CHECK(memory().limit == 4000);
  CHECK(memory().available == 1000);
  group.write("memory.stat", "anon 1000\ninactive_file 500\nactive_file 20");
  CHECK(memory().available == 1500);
  group.write("memory.current", "9000");
  CHECK(memory().available == 0);
  CHECK(available_memory() > 0);  // of this machine
  CHECK(available_memory() < 1e17);
}
