#include "core/app/python/run_store.h"

#include <stdlib.h>

#include <stdexcept>

#include "core/numerics/mesh_files/io.h"

namespace drape::python {

namespace fs = std::filesystem;

RunFolderHandle::RunFolderHandle() {
  std::string name = (fs::temp_directory_path() / "drape_run_XXXXXX").string();
  if (!mkdtemp(name.data()))
    throw std::runtime_error("no temporary folder can be made in " + fs::temp_directory_path().string() +
                             "; give the run a folder, as in out=\"results/mine\"");
  temporary_ = name;
  path_ = temporary_ / "run";
}

RunFolderHandle::~RunFolderHandle() {
  std::error_code ignored;
  if (!temporary_.empty()) fs::remove_all(temporary_, ignored);
}

std::shared_ptr<const TriangleMesh> RunStore::mesh(const std::string& name) const {
  if (name.empty()) throw std::runtime_error("the run has stored no state of this level");
  auto& found = meshes_[name];
  if (!found) found = std::make_shared<const TriangleMesh>(read_mesh(data.folder / name));
  return found;
}

}  // namespace drape::python
