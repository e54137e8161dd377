#include "core/app/run/checkpoint.h"

#include <limits>
#include <utility>

#include "core/app/files/archive.h"
#include "core/kernel/files/file.h"

namespace drape {

/// An outcome is valid if it has a name, and so is a verdict.
bool is_value(Outcome outcome) { return *to_string(outcome) != '\0'; }

bool is_value(Stability::Verdict verdict) { return *to_string(verdict) != '\0'; }

bool is_value(LinearSolver solver) {
  return solver >= LinearSolver::automatic && solver <= LinearSolver::cholmod;
}

namespace {

constexpr std::string_view magic = "drapestt";
/// Raise it with the first change after a release to what a checkpoint holds.
constexpr std::uint32_t format = 3;

struct Header {
  std::uint32_t format = drape::format, checksum = 0;
  std::uint64_t size = 0;
};

/// The files of a run's checkpoints. A save writes `upcoming`, which is whole if it was cut between its
/// renames.
constexpr std::string_view newest = "checkpoint/state.bin", previous = "checkpoint/previous.bin",
                           upcoming = "checkpoint/next.bin";

}  // namespace

std::string encode_body(const Checkpoint& checkpoint) {
  ArchiveWriter body;
  pass(body, const_cast<Checkpoint&>(checkpoint));  // which writing does not change
  return std::move(body.bytes);
}

std::string encode(const Checkpoint& checkpoint) {
  const std::string body = encode_body(checkpoint);
  Header header;
  header.size = body.size();
  header.checksum = checksum_of(body);
  ArchiveWriter whole;
  whole.bytes = magic;
  pass(whole, header);
  return whole.bytes + body;
}

Checkpoint decode(std::string_view bytes) {
  if (!bytes.starts_with(magic.substr(0, std::min(bytes.size(), magic.size()))))
    throw std::runtime_error("is no checkpoint of drape");
  constexpr std::size_t header_size = magic.size() + 16;
  if (bytes.size() < header_size) throw std::runtime_error("is cut short");
  Header header;
  ArchiveReader header_reader{bytes.substr(magic.size())};
  pass(header_reader, header);
  if (header.format != format)
    throw std::runtime_error("is a checkpoint of format " + std::to_string(header.format) +
                             ", but this drape reads format " + std::to_string(format) +
                             "; resume it with the drape that wrote it");
  bytes.remove_prefix(header_size);
  if (bytes.size() < header.size) throw std::runtime_error("is cut short");
  if (bytes.size() > header.size || checksum_of(bytes) != header.checksum)
    throw std::runtime_error("is damaged: its checksum does not fit");
  return decode_body(bytes);
}

Checkpoint decode_body(std::string_view bytes) {
  ArchiveReader reader{bytes};
  Checkpoint checkpoint;
  try {
    pass(reader, checkpoint);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(std::string("is damaged: ") + fault.what());
  }
  if (!reader.bytes.empty()) throw std::runtime_error("is damaged: it has data after its end");
  return checkpoint;
}

void save_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
  const std::filesystem::path file = folder / newest, next = folder / upcoming;
  make_folder(file.parent_path());
  write_file(next, encode(checkpoint));
  sync_to_disk(next);
  std::error_code none;
  if (std::filesystem::exists(file, none)) rename_file(file, folder / previous);
  rename_file(next, file);
  sync_to_disk(file.parent_path());
}

bool has_checkpoint(const std::filesystem::path& folder) {
  std::error_code none;  // between the two renames of a save there is the previous one alone
  return std::filesystem::exists(folder / newest, none) || std::filesystem::exists(folder / previous, none);
}

Checkpoint load_checkpoint(const std::filesystem::path& folder, std::vector<std::string>& warnings) {
  std::string faults;
  for (const std::string_view name : {newest, previous, upcoming}) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::exists(file) || (faults.empty() && name == upcoming)) continue;
    try {
      // The cloth sets its size: a limit would lose the runs of large ones.
      Checkpoint checkpoint = decode(read_file(file, std::numeric_limits<std::uintmax_t>::max()));
      if (!faults.empty()) warnings.push_back(faults + "; going on from " + file.string());
      return checkpoint;
    } catch (const std::exception& fault) {
      faults += (faults.empty() ? "" : "; ") + file.string() + ": " + fault.what();
    }
  }
  if (faults.empty())
    refuse_path(
        folder,
        "holds no checkpoint of a run: one that ended before its first method began has none. Run the "
        "experiment again with --overwrite, or give the results folder of another run");
  throw std::runtime_error(faults + "; no checkpoint is whole: run the experiment again, as in drape run " +
                           (folder / "config.yaml").string() + " --out ANOTHER");
}

void remove_checkpoints(const std::filesystem::path& folder) {
  std::error_code error;
  for (const std::string_view name : {newest, previous, upcoming})
    std::filesystem::remove(folder / name, error);
}

}  // namespace drape
