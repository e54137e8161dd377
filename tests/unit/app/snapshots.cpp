#include <catch2/catch.hpp>

#include "core/app/files/snapshot_file.h"
#include "core/app/run/errors.h"
#include "tests/support/command.h"

using namespace drape;

namespace {

Positions positions_at(int iteration) { return Positions::Constant(4, 3, iteration / 3.0); }

/// The iterations that are kept of so many.
std::vector<int> kept(int most, int iterations) {
  SnapshotRecorder snapshots(most);
  snapshots.begin_level();
  for (int k = 1; k <= iterations; ++k) snapshots.iteration({0.1 * k, k, 5.0 * k}, positions_at(k));
  std::vector<int> of;
  for (const Snapshot& snapshot :
       snapshots.end_level({0.1 * iterations, iterations, 0}, positions_at(iterations))) {
    CHECK((snapshot.x - positions_at(snapshot.cost.iterations)).norm() == 0);
    of.push_back(snapshot.cost.iterations);
  }
  return of;
}

}  // namespace

TEST_CASE("snapshots are spread evenly, never more than asked for, the last state among them") {
  CHECK(kept(8, 0) == std::vector{0});
  CHECK(kept(8, 1) == std::vector{1});
  CHECK(kept(8, 5) == std::vector{1, 2, 3, 4, 5});
  CHECK(kept(8, 7) == std::vector{1, 2, 3, 4, 5, 6, 7});
  CHECK(kept(8, 8) == std::vector{1, 3, 5, 7, 8});
  CHECK(kept(8, 100) == std::vector{1, 17, 33, 49, 65, 81, 97, 100});
  CHECK(kept(1, 9) == std::vector{9});
  CHECK(kept(2, 9) == std::vector{1, 9});
  for (int most = 1; most < 12; ++most)
    for (int n = 0; n < 200; ++n) {
      const std::vector<int> all = kept(most, n);
      REQUIRE(static_cast<int>(all.size()) <= most);
      REQUIRE(all.back() == n);
    }
}

TEST_CASE("a snapshots file reads back in single precision; one cut short or damaged is refused") {
  const Scratch folder;
  const std::filesystem::path file = folder / "f.bin";
  const std::uint32_t checksum = write_snapshots(file, {{{}, positions_at(1)}, {{}, positions_at(2)}});
  CHECK(std::filesystem::file_size(file) == 2 * 4 * 3 * 4);
  const SnapshotFile read(file, 2, 4, checksum);
  REQUIRE(read.count() == 2);
  CHECK((read.positions(0) - positions_at(1)).norm() < 1e-6);
  CHECK((read.positions(1) - positions_at(2)).norm() < 1e-6);
  CHECK(SnapshotFile(file, 2, 4, std::nullopt).count() == 2);
  CHECK_THROWS_WITH(SnapshotFile(file, 2, 5, checksum),
                    Catch::EndsWith("f.bin: holds 96 bytes, not 2 snapshots of 5 vertices"));
  folder.damage("f.bin");
  CHECK_THROWS_WITH(SnapshotFile(file, 2, 4, checksum),
                    Catch::EndsWith("f.bin: is damaged: its checksum does not fit"));
}
