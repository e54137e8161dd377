#include "core/kernel/plugin/shared_library.h"

#include <elf.h>
#include <link.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <stdexcept>
#include <vector>

namespace drape {
namespace {

namespace fs = std::filesystem;

using FileHeader = ElfW(Ehdr);
using ProgramHeader = ElfW(Phdr);
using SectionHeader = ElfW(Shdr);

/// Reads parts of a file, each checked against its size.
class Bytes {
 public:
  explicit Bytes(const fs::path& file) : stream_(file, std::ios::binary), size_(fs::file_size(file)) {
    if (!stream_) throw std::runtime_error("it cannot be read; check its permissions");
  }

  /// Throws std::runtime_error if the file ends before `size` bytes from `offset` on.
  void require(std::uint64_t offset, std::uint64_t size) const {
    if (offset <= size_ && size <= size_ - offset) return;
    throw std::runtime_error("the file is cut short at " + std::to_string(size_) +
                             " bytes, its headers tell of more; build or copy it again");
  }
  template <class T>
  std::vector<T> read(std::uint64_t offset, std::size_t count) {
    require(offset, count * sizeof(T));
    std::vector<T> values(count);
    const auto bytes = static_cast<std::streamsize>(count * sizeof(T));
    stream_.seekg(static_cast<std::streamoff>(offset));
    if (!stream_.read(reinterpret_cast<char*>(values.data()), bytes))
      throw std::runtime_error("it cannot be read; check the disk that it is on");
    return values;
  }

 private:
  std::ifstream stream_;
  std::uint64_t size_;
};

FileHeader header_of(Bytes& bytes) {
  const auto header = bytes.read<FileHeader>(0, 1).front();
  if (std::memcmp(header.e_ident, ELFMAG, SELFMAG) != 0)
    throw std::runtime_error("it is no shared library (ELF); take it out of the folder or build it again");
  return header;
}

void require_same_machine(const FileHeader& theirs) {
  Bytes own_bytes("/proc/self/exe");
  const FileHeader own = header_of(own_bytes);
  if (theirs.e_machine != own.e_machine || theirs.e_ident[EI_CLASS] != own.e_ident[EI_CLASS] ||
      theirs.e_ident[EI_DATA] != own.e_ident[EI_DATA])
    throw std::runtime_error("it is made for another kind of machine; build it on this one");
  if (theirs.e_type != ET_DYN)
    throw std::runtime_error("it is no shared library but another kind of ELF file; link it with -shared");
}

void require_whole(Bytes& bytes, const FileHeader& header) {
  if (header.e_phentsize != sizeof(ProgramHeader) || header.e_phnum == 0 ||
      (header.e_shnum > 0 && header.e_shentsize != sizeof(SectionHeader)))
    throw std::runtime_error("its headers are damaged; build or copy it again");
  for (const ProgramHeader& part : bytes.read<ProgramHeader>(header.e_phoff, header.e_phnum)) {
    bytes.require(part.p_offset, part.p_filesz);
    if (part.p_type == PT_LOAD && part.p_filesz > part.p_memsz)
      throw std::runtime_error("its headers are damaged; build or copy it again");
  }
  for (const SectionHeader& part : bytes.read<SectionHeader>(header.e_shoff, header.e_shnum))
    if (part.sh_type != SHT_NOBITS && part.sh_type != SHT_NULL) bytes.require(part.sh_offset, part.sh_size);
}

}  // namespace

std::string fault_of_library(const fs::path& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (error && status.type() != fs::file_type::not_found) return error.message();
  if (!fs::exists(status)) return "there is no such file; does the link lead nowhere?";
  if (!fs::is_regular_file(status)) return "it is not a regular file; take it out of the folder";
  try {
    Bytes bytes(file);
    const FileHeader header = header_of(bytes);
    require_same_machine(header);
    require_whole(bytes, header);
    return "";
  } catch (const std::exception& fault) {
    return fault.what();
  }
}

}  // namespace drape
