#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>

#include "core/app/scene/scene.h"

namespace drape {
struct RegistryEntry;
}

namespace drape::python {

namespace py = pybind11;

/// A Python object that C++ holds: copied and destroyed in any thread, with the GIL or without.
using SharedObject = std::shared_ptr<const py::object>;
SharedObject share(py::object object);

/// A call from C++ into Python, for as long as the object lives. Calls nest, where Python calls C++ that
/// calls Python.
class PythonCall {
 public:
  PythonCall();
  ~PythonCall();
  PythonCall(const PythonCall&) = delete;
  PythonCall& operator=(const PythonCall&) = delete;

  /// Stores the exception in flight, of this thread, unless an earlier one is stored or the call is nested:
  /// then Python may yet handle it. For use in a handler.
  void remember_failure() const;

 private:
  py::gil_scoped_acquire gil_;
};

/// For the life of a run, whose calls nest from here: none of the Python that is under way sees them fail.
/// What was stored before is forgotten.
class OwnCalls {
 public:
  OwnCalls();
  ~OwnCalls();
  OwnCalls(const OwnCalls&) = delete;
  OwnCalls& operator=(const OwnCalls&) = delete;

 private:
  int outer_;
};

/// Whether an exception is stored in this thread.
bool has_failed();
/// Raises the exception that is stored, if any. Call with the GIL held.
void raise_failure();

/// Calls `body`, which uses Python, from C++ that holds no GIL. An exception goes on through C++, where a run
/// turns it into the failure of a method; it is stored too, so that the binding can raise it.
template <class Body>
auto with_python(const Body& body) {
  const PythonCall call;
  try {
    return body();
  } catch (...) {
    call.remember_failure();
    throw;
  }
}

/// C++ at work without the GIL, for as long as the object lives. A thread that asked for the GIL after the
/// interpreter's end would take the process with it, so the end waits for all of them.
class WithoutGil {
 public:
  /// Whether the interpreter ends: runs then stop as on a request.
  static bool to_end() { return to_end_; }
  /// For the interpreter's end. A signal's handler may raise an exception.
  static void wait_for_all();
  /// Throws std::runtime_error once the interpreter has waited for all. Call with the GIL held.
  static void refuse_after_end();

 private:
  struct Counted {
    Counted() { ++under_way; }
    ~Counted() { --under_way; }
    Counted(const Counted&) = delete;
    Counted& operator=(const Counted&) = delete;
    inline static int under_way = 0;  // guarded by the GIL
  };
  inline static std::atomic<bool> to_end_ = false;
  Counted counted_;
  py::gil_scoped_release released_;
};

/// The result of `body`, which runs without the GIL: it takes long, or calls prototypes, which take it
/// themselves.
template <class Body>
auto without_gil(const Body& body) {
  WithoutGil::refuse_after_end();
  const WithoutGil released;
  return body();
}

/// The process's plugins, loaded at the first call, and the prototypes that Python has registered. Call with
/// the GIL held. Throws std::runtime_error for a library that cannot be loaded.
const Registry& registry();

/// Registers a prototype's entry; it takes the place of an earlier prototype of the same kind and name.
/// Throws std::runtime_error if a plugin's library has the name.
void register_prototype(std::unique_ptr<RegistryEntry> entry);

/// A level that Python may keep, as a part of `owner`. Not const, because pybind11 knows no pointers to
/// const; Python can change none.
inline std::shared_ptr<Level> level_of(const std::shared_ptr<const void>& owner, const Level& level) {
  return {std::const_pointer_cast<void>(owner), const_cast<Level*>(&level)};
}

/// A model with what must outlive it: the scene, or for a prototype's solver the solve under way.
struct ModelHandle {
  std::shared_ptr<const LevelModel> shared;
  std::shared_ptr<const void> owner;       ///< of the level; null if it is not known
  std::shared_ptr<const bool> alive = {};  ///< whether the level still exists; null if `owner` sees to that

  /// Throws RuntimeError once the solve that gave the model has ended.
  const LevelModel& model() const {
    if (alive && !*alive)
      throw std::runtime_error("this model belongs to a solve that has ended; copy what you need before");
    return *shared;
  }
  std::shared_ptr<Level> level() const {
    const Level& own = model().level();
    return owner ? level_of(owner, own) : std::make_shared<Level>(own);
  }
  int vertex_count() const { return model().level().vertex_count(); }
};

/// A scene with the experiment that it refers to.
struct SceneHandle {
  std::shared_ptr<const Experiment> experiment;
  std::shared_ptr<const Scene> scene;

  /// Throws IndexError for a level that does not exist.
  int checked(int level) const {
    if (level < 0) level += static_cast<int>(scene->models.size());
    if (level < 0 || level >= static_cast<int>(scene->models.size()))
      throw py::index_error("the scene has the levels 0 … " + std::to_string(scene->models.size() - 1));
    return level;
  }
  ModelHandle model(int l) const { return {scene->models[checked(l)], scene}; }
};

/// An experiment as written; it is read again whenever it is used.
struct ExperimentHandle {
  ConfigNode source;

  /// Throws drape.ConfigError.
  std::shared_ptr<const Experiment> read(LargeMemory large = LargeMemory::allowed) const;
  SceneHandle scene(bool allow_memory) const;
};

/// Issues a UserWarning for everything about the scene that no fabric has.
void warn_of_implausible(const SceneHandle& scene);

/// An iteration of a method, and its state.
struct Iteration : IterationRow {
  Positions x;
  std::string method;
};

/// The result of one level of a method.
struct MethodLevelResult : LevelResult {
  std::string method;
};

// The implementations of the kernel's interfaces by objects of Python's classes (drape/prototypes.py), as
// pointers to the interface. Call with the GIL held. They throw TypeError or ValueError for a declaration
// that is not one.

std::shared_ptr<Energy> prototype_energy(const py::object& prototype);
std::shared_ptr<Solver> prototype_solver(const py::object& prototype);

// What each file adds to the module; Python's own part of the package is in drape/.

void bind_scene(py::module_& m);         ///< Material, Level, Scene
void bind_model(py::module_& m);         ///< Model: energies and their derivatives
void bind_experiment(py::module_& m);    ///< Experiment
void bind_run(py::module_& m);           ///< Iteration, LevelResult, Experiment.run, what a run has written
void bind_solve(py::module_& m);         ///< Solve: a method step by step
void bind_prototypes(py::module_& m);    ///< registering Python classes as plugins
void bind_bound_energy(py::module_& m);  ///< BoundEnergy
void bind_prototype_problem(py::module_& m);  ///< Problem: what a solver in Python works on

}  // namespace drape::python
