// The file that a run goes on from: what was saved is what is read, and nothing else is.

#include "core/app/run/checkpoint.h"

#include <catch2/catch.hpp>
#include <utility>

#include "tests/support/command.h"
#include "tests/support/full_checkpoint.h"
#include "tests/support/refusal.h"

using namespace drape;
using Catch::Contains;
using Catch::EndsWith;

namespace {

std::string error_of(const std::string& bytes) {
  return refusal_of([&] { decode(bytes); });
}

std::string error_of_body(const std::string& bytes) {
  return refusal_of([&] { decode_body(bytes); });
}

/// The place of the one byte in which two bodies differ.
std::size_t difference(const std::string& a, const std::string& b) {
  REQUIRE(a.size() == b.size());
  const auto at = static_cast<std::size_t>(std::mismatch(a.begin(), a.end(), b.begin()).first - a.begin());
  REQUIRE(at < a.size());
  REQUIRE(a.substr(at + 1) == b.substr(at + 1));
  return at;
}

std::string error_in(const std::filesystem::path& folder) {
  std::vector<std::string> warnings;
  return refusal_of([&] { load_checkpoint(folder, warnings); });
}

}  // namespace

TEST_CASE("A checkpoint is read as it was written") {
  const std::string bytes = encode(full_checkpoint());
  const Checkpoint c = decode(bytes);
  CHECK(encode(c) == bytes);
  // The archive passes every member of a struct: here one of each kind of value.
  CHECK(c.methods == std::vector<std::string>{"pcs", "newton"});
  CHECK(c.state.finished.at(0).x == full_checkpoint().state.finished.at(0).x);
  CHECK(c.state.finished.at(0).seconds_by_phase.at("solve") == 0.5);
  const NewtonState& s = c.state.under_way.value();
  CHECK(std::isnan(s.so_far.force_residual));
  CHECK(s.iterate.limited_by == "ball");
  CHECK(s.step.controller.stall_count == -4);
  CHECK(s.step.factor.pattern.extra.blocks.at(1) == std::pair(2, 7));
  CHECK(s.step.factor.fallback == LinearSolver::supernodal);
  CHECK(s.check.decrements == std::array<double, 3>{1, 2, 3});
  CHECK(s.check.initial_centroid == Eigen::RowVector3d(7, 8, 9));
  CHECK(s.contacts.tangential_displacements.at(0).at(0).contact == ContactKey{1, 2, 3, 4, 0});
  CHECK(s.contacts.damping.lag.at(0).at(0).at(0).touched.obstacle == 3);
  CHECK(s.switched_to_plain);
  CHECK(c.recorder.states.at(0).snapshots.checksum == 7);
  CHECK(c.recorder.iterations_bytes == 12345);
  CHECK(encode(decode(encode(Checkpoint()))) == encode(Checkpoint()));
}

TEST_CASE("Any changed, missing or additional byte of a checkpoint is detected") {
  const std::string bytes = encode(full_checkpoint());
  REQUIRE(bytes.size() > 1000);
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string other = bytes;
    other[k] = static_cast<char>(other[k] ^ (1 << k % 8));
    CAPTURE(k);
    REQUIRE(error_of(other) != "");
    REQUIRE(error_of(bytes.substr(0, k)) != "");
  }
  std::string other = bytes;
  other[500] ^= 1;
  CHECK(error_of(other) == "is damaged: its checksum does not fit");
  CHECK(error_of(bytes + "x") == "is damaged: its checksum does not fit");
  CHECK(error_of(bytes.substr(0, 900)) == "is cut short");
  CHECK(error_of("") == "is cut short");
  CHECK(error_of("ply\nformat ascii 1.0\n") == "is no checkpoint of drape");
  other = bytes;
  other[8] = 77;
  CHECK(
      error_of(other) ==
      "is a checkpoint of format 77, but this drape reads format 1; resume it with the drape that wrote it");
}

TEST_CASE("A value that its type does not have is refused") {
  const Checkpoint whole = full_checkpoint();
  std::string bytes = encode_body(whole);
  Checkpoint other = whole;
  other.recorder.intersection_free = !whole.recorder.intersection_free;
  const std::size_t flag = difference(bytes, encode_body(other));
  other = whole;
  other.state.finished[0].outcome = Outcome::infeasible;
  const std::size_t outcome = difference(bytes, encode_body(other));
  for (const int wrong : {2, 3, 128, 255}) {
    std::string damaged = bytes;
    damaged[flag] = static_cast<char>(wrong);
    CHECK(error_of_body(damaged) == "is damaged: it has " + std::to_string(wrong) + " for yes or no");
  }
  bytes[outcome + 2] = 1;
  CHECK_THAT(error_of_body(bytes), Contains("for one of a list of words"));
}

TEST_CASE("A count of more than there are bytes is refused before memory is taken for it") {
  Checkpoint c;
  const std::string bytes = encode_body(c);
  c.methods = {""};
  const std::string with_one = encode_body(c);
  const auto at = static_cast<std::size_t>(std::mismatch(bytes.begin(), bytes.end(), with_one.begin()).first -
                                           bytes.begin());
  for (const std::size_t byte : {1u, 3u, 7u}) {
    std::string damaged = bytes;
    damaged[at + byte] = 0x7f;
    CHECK(error_of_body(damaged) == "is damaged: it ends too early");
  }
}

TEST_CASE("Whatever bytes a body has, it is refused or read as what would be written so") {
  const std::string bytes = encode_body(full_checkpoint());
  int read = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k)
    for (const int value : {0, 1, 2, 127, 255}) {
      std::string other = bytes;
      other[k] = static_cast<char>(value);
      CAPTURE(k, value);
      if (error_of_body(other) != "") continue;
      ++read;
      REQUIRE(encode_body(decode_body(other)) == other);
    }
  CHECK(read > 1000);
}

TEST_CASE("The newest complete checkpoint is used, and a damaged one is named") {
  const Scratch folder;
  CHECK_FALSE(has_checkpoint(folder.path));
  CHECK_THAT(error_in(folder.path), Contains("holds no checkpoint of a run"));
  std::vector<std::string> warnings;
  for (int method = 0; method < 3; ++method) {
    Checkpoint c = full_checkpoint();
    c.method = method;
    save_checkpoint(folder.path, c);
    CHECK(load_checkpoint(folder.path, warnings).method == method);
    CHECK(warnings.empty());
  }
  const auto newest = folder / "checkpoint/state.bin", previous = folder / "checkpoint/previous.bin";
  const std::string whole = text_of(newest);
  std::filesystem::resize_file(newest, whole.size() - 1);
  CHECK(load_checkpoint(folder.path, warnings).method == 1);
  CHECK(std::exchange(warnings, {}) ==
        std::vector{newest.string() + ": is cut short; going on from " + previous.string()});

  // Between the two renames of a save there is no newest one.
  std::filesystem::remove(newest);
  CHECK(has_checkpoint(folder.path));
  CHECK(load_checkpoint(folder.path, warnings).method == 1);
  CHECK(warnings.empty());

  folder.write("checkpoint/state.bin", whole.substr(0, 100));
  folder.write("checkpoint/previous.bin", "something else");
  // A save that was cut between its renames has left the next one.
  folder.write("checkpoint/next.bin", whole);
  CHECK(load_checkpoint(folder.path, warnings).method == 2);
  folder.damage("checkpoint/next.bin");
  const std::string error = error_in(folder.path);
  CHECK_THAT(error, Contains("state.bin: is cut short; ") && Contains("previous.bin: is no checkpoint"));
  CHECK_THAT(error, EndsWith("no checkpoint is whole: run the experiment again, as in drape run " +
                             (folder / "config.yaml").string() + " --out ANOTHER"));
}
