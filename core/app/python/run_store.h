#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <map>
#include <memory>

#include "core/app/report/run_data.h"
#include "core/kernel/interfaces/triangle_mesh.h"

namespace drape::python {

namespace py = pybind11;

/// A results folder, removed with the object if it is a temporary one.
class RunFolderHandle {
 public:
  /// An existing folder, which stays.
  explicit RunFolderHandle(std::filesystem::path path) : path_(std::move(path)) {}
  /// A new temporary folder. Throws std::runtime_error if there is none to be had.
  RunFolderHandle();
  ~RunFolderHandle();
  RunFolderHandle(const RunFolderHandle&) = delete;
  RunFolderHandle& operator=(const RunFolderHandle&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_, temporary_;
};

/// What a run has written, with its meshes as they are asked for. Used with the GIL held.
class RunStore {
 public:
  explicit RunStore(std::shared_ptr<const RunFolderHandle> folder)
      : data(read_run(folder->path())), folder_(std::move(folder)) {}

  /// The state of a level, read once.
  std::shared_ptr<const TriangleMesh> mesh(const std::string& name) const;

  const RunData data;

 private:
  std::shared_ptr<const RunFolderHandle> folder_;
  mutable std::map<std::string, std::shared_ptr<const TriangleMesh>> meshes_;
};

}  // namespace drape::python
