#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace drape {
class Registry;
}

/// A plugin library's description of itself in plain C, read before any of its C++ is called.
struct DrapePluginDescriptor {
  std::uint32_t magic;       ///< DRAPE_ABI_MAGIC
  std::uint32_t abi_number;  ///< DRAPE_ABI_NUMBER; the fields below are read only if it matches
  const char* build;         ///< DRAPE_BUILD: what decides about the layout of classes
  void (*register_entries)(drape::Registry&);
};

// Macros, not inline functions: the dynamic linker would resolve an inline function in the plugin to the core
// library's copy, and every plugin would seem to match.

#define DRAPE_ABI_MAGIC 0x50415244u  // "DRAP"
/// Raise it with the first change after a release to a class that crosses the library boundary.
#define DRAPE_ABI_NUMBER 3u

#define DRAPE_TEXT_(x) #x
#define DRAPE_TEXT(x) DRAPE_TEXT_(x)

#if defined(__clang__)
#define DRAPE_COMPILER "Clang " DRAPE_TEXT(__clang_major__) "." DRAPE_TEXT(__clang_minor__)
#else
#define DRAPE_COMPILER "GCC " DRAPE_TEXT(__GNUC__) "." DRAPE_TEXT(__GNUC_MINOR__)
#endif

#if defined(_LIBCPP_VERSION)
#define DRAPE_STANDARD_LIBRARY "libc++ " DRAPE_TEXT(_LIBCPP_VERSION)
#else
#define DRAPE_STANDARD_LIBRARY \
  "libstdc++ " DRAPE_TEXT(_GLIBCXX_RELEASE) " with C++11 ABI " DRAPE_TEXT(_GLIBCXX_USE_CXX11_ABI)
#endif

/// As "GCC 12.2, libstdc++ 12 with C++11 ABI 1, Eigen 3.4.0 aligned to 64 bytes". The alignment follows from
/// the machine's vector width (-march).
#define DRAPE_BUILD                                                                              \
  DRAPE_COMPILER                                                                                 \
  ", " DRAPE_STANDARD_LIBRARY                                                                    \
  ", Eigen " DRAPE_TEXT(EIGEN_WORLD_VERSION) "." DRAPE_TEXT(EIGEN_MAJOR_VERSION) "." DRAPE_TEXT( \
      EIGEN_MINOR_VERSION) " aligned to " DRAPE_TEXT(EIGEN_MAX_ALIGN_BYTES) " bytes"

/// The descriptor of the library under compilation.
#define DRAPE_ABI_DESCRIPTOR(register_entries) \
  { DRAPE_ABI_MAGIC, DRAPE_ABI_NUMBER, DRAPE_BUILD, register_entries }

namespace drape {

/// Why a library is not compatible with this one, naming both sides; empty if it is.
std::string mismatch(const DrapePluginDescriptor& theirs);

}  // namespace drape
