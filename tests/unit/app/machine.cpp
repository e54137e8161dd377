#include "core/app/files/machine.h"

#include <catch2/catch.hpp>

#include "tests/support/command.h"

using namespace drape;

TEST_CASE(
    "A container's memory is what its limit leaves, without the files that the kernel drops on demand") {
  const Scratch group;
  CHECK(ContainerMemory::of(group.path).limit > 1e17);
  group.write("memory.max", "max");  // no limit
  CHECK(ContainerMemory::of(group.path).available > 1e17);
  group.write("memory.max", "4000");
  group.write("memory.current", "3000");
  CHECK(ContainerMemory::of(group.path).limit == 4000);
  CHECK(ContainerMemory::of(group.path).available == 1000);
  group.write("memory.stat", "anon 1000\ninactive_file 500\nactive_file 20");
  CHECK(ContainerMemory::of(group.path).available == 1500);
  group.write("memory.current", "9000");
  CHECK(ContainerMemory::of(group.path).available == 0);
}

TEST_CASE("This machine's available memory is known") {
  CHECK(available_memory() > 0);
  CHECK(available_memory() < 1e17);
}
