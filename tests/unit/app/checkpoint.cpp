// The file that a run goes on from: what was saved is what is read, and nothing else is.

#include "core/app/run/checkpoint.h"

#include <algorithm>
#include <catch2/catch.hpp>
#include <utility>

#include "tests/support/command.h"
#include "tests/support/full_checkpoint.h"
#include "tests/support/refusal.h"

using namespace drape;
using Catch::Contains;
using Catch::EndsWith;
using Catch::StartsWith;

namespace {

std::string checkpoint_error(const std::string& bytes) {
  return refusal_of([&] { decode(bytes); });
}

std::string error_in_folder(const std::filesystem::path& folder) {
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
  CHECK(s.step.controller.stall_count == -4);
  CHECK(s.step.factor.pattern.extra.blocks.at(1) == std::pair(2, 7));
  CHECK(s.step.factor.fallback == LinearSolver::supernodal);
  CHECK(s.check.decrements == std::array<double, 3>{1, 2, 3});
  CHECK(s.contacts.tangential_displacements.at(0).at(0).contact == ContactKey{1, 2, 3, 4, 0});
  CHECK(s.switched_to_plain);
  CHECK(c.recorder.states.at(0).snapshots.checksum == 7);
  CHECK(encode(decode(encode(Checkpoint()))) == encode(Checkpoint()));
}

TEST_CASE("Any changed, missing or additional byte of a checkpoint is detected") {
  const std::string bytes = encode(full_checkpoint());
  REQUIRE(bytes.size() > 1000);
  const auto with_byte = [&](std::size_t at, int value) {
    std::string other = bytes;
    other[at] = static_cast<char>(value);
    return checkpoint_error(other);
  };
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    CAPTURE(k);
    REQUIRE(with_byte(k, bytes[k] ^ (1 << k % 8)) != "");
    REQUIRE(checkpoint_error(bytes.substr(0, k)) != "");
  }
  const std::string damaged = "is damaged: its checksum does not fit";
  CHECK(with_byte(500, bytes[500] ^ 1) == damaged);
  CHECK(checkpoint_error(bytes + "x") == damaged);
  for (const std::size_t length : {0u, 900u})
    CHECK(checkpoint_error(bytes.substr(0, length)) == "is cut short");
  CHECK(checkpoint_error("ply\nformat ascii 1.0\n") == "is no checkpoint of drape");
  CHECK(with_byte(8, 77) ==
        "is a checkpoint of format 77, but this drape reads format 3; resume it with the drape "
        "that wrote it");
}

TEST_CASE("Whatever bytes a body has, it is refused or read as what would be written so") {
  const Checkpoint whole = full_checkpoint();
  const std::string bytes = encode_body(whole);
  const auto error_of_body = [](const std::string& body) { return refusal_of([&] { decode_body(body); }); };
  int read = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k)
    for (const int value : {0, 1, 2, 127, 255}) {
      std::string other = bytes;
      other[k] = static_cast<char>(value);
      CAPTURE(k, value);
      const std::string error = error_of_body(other);
      if (error == "") {
        ++read;
        REQUIRE(encode_body(decode_body(other)) == other);
      } else {
        REQUIRE_THAT(error, StartsWith("is damaged: "));  // before memory is taken for a count
      }
    }
  CHECK(read > 1000);

  Checkpoint other = whole;
  other.state.finished[0].outcome = Outcome::infeasible;
  std::string no_word = encode_body(other);
  const auto at = std::ranges::mismatch(bytes, no_word).in2 - no_word.begin();
  no_word[at + 2] = 1;
  CHECK_THAT(error_of_body(no_word), Contains("for one of a list of words"));
}

TEST_CASE("The newest complete checkpoint is used, and a damaged one is named") {
  const Scratch folder;
  CHECK_FALSE(has_checkpoint(folder.path));
  CHECK_THAT(error_in_folder(folder.path), Contains("holds no checkpoint of a run"));
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
  const std::string error = error_in_folder(folder.path);
  CHECK_THAT(error, Contains("state.bin: is cut short; ") && Contains("previous.bin: is no checkpoint"));
  CHECK_THAT(error, EndsWith("no checkpoint is whole: run the experiment again, as in drape run " +
                             (folder / "config.yaml").string() + " --out ANOTHER"));
}
