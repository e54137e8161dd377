// The state of a run, beneath its checksum: with that in the way, nothing else would be tested.

#include "core/app/run/checkpoint.h"

#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <stdexcept>

#include "tests/fuzz/require.h"
#include "tests/support/full_checkpoint.h"

using namespace drape;

/// `fuzz_checkpoint --seed FILE` writes that: made of this build's fields, it never gets old.
extern "C" int LLVMFuzzerInitialize(int* count, char*** words) {
  if (*count != 3 || std::string_view((*words)[1]) != "--seed") return 0;
  std::ofstream((*words)[2], std::ios::binary) << encode_body(full_checkpoint());
  std::exit(0);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    require(encode_body(decode_body(bytes)) == bytes, "what was read is written otherwise");
  } catch (const std::runtime_error&) {  // it is refused
  }
  return 0;
}
