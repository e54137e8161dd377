// The state of a run, beneath its checksum: with that in the way, nothing else would be tested.

#include "core/app/run/checkpoint.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <stdexcept>

namespace {

using namespace drape;

std::string body(const Checkpoint& checkpoint) { return encode(checkpoint).substr(checkpoint_header_size); }

/// A small one, for the fuzzer to begin with.
Checkpoint small() {
  Checkpoint c;
  c.program = "drape";
  c.config = "name: x\n";
  c.files = {{"/a.obj", 17, 99}};
  c.methods = {"pcs", "newton"};
  LevelResult coarse;
  coarse.message = "no descent";
  coarse.x = Positions::Ones(4, 3);
  coarse.seconds_by_phase = {{"solve", 0.5}};
  coarse.smallest_gap = 1e-4;
  c.state.finished = {coarse};
  NewtonState& s = c.state.under_way.emplace();
  s.so_far.x = Positions::Ones(4, 3);
  s.iterate.limited_by = "ball";
  s.contacts.tangential_displacements = {{{{1, 2, 3, 4, 0}, {1e-5, 0, 2e-5}}}, {}};
  s.step.factor.pattern.extra = {{{0, 4}, {2, 7}}, {0, 3}};
  s.step.factor.analysis = {{0, 1, 0}, {2, 0}, {0, 2}, 123, 4};
  c.start = Positions::Ones(4, 3);
  c.recorder.results = "{}";
  return c;
}

}  // namespace

/// `fuzz_checkpoint --seed FILE` writes that: made of this build's fields, it never gets old.
extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  if (*count != 3 || std::string_view((*words)[1]) != "--seed") return 0;
  std::ofstream((*words)[2], std::ios::binary) << body(small());
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    if (body(decode_body(bytes)) == bytes) return 0;
  } catch (const std::runtime_error&) {
    return 0;
  }
  std::cerr << "broken: what was read is written otherwise" << std::endl;
  std::abort();
}
