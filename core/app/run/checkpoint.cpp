#include "core/app/run/checkpoint.h"

#include "core/app/files/archive.h"
#include "core/kernel/files/file.h"

namespace drape {

/// An outcome is valid if it has a name.
bool is_value(Outcome outcome) { return *to_string(outcome) != '\0'; }

bool is_value(LinearSolver solver) {
  return solver >= LinearSolver::automatic && solver <= LinearSolver::cholmod;
}

// Fields of a checkpoint's structs; `format` below says which they are.

template <class A>
void fields(A& a, LoadSteppingState& s) {
  a(s.increment, s.values);
}

template <class A>
void fields(A& a, DirichletEnforcer::State& m) {
  a(m.unsatisfied, m.stiffness, m.best, m.idle, m.infeasible, m.released, m.blocked_by);
}

template <class A>
void fields(A& a, IncrementStart& c) {
  a(c.steps, c.iterations, c.seconds);
}

template <class A>
void fields(A& a, IncrementResponse& r) {
  a(r.from, r.predicted, r.fraction);
}

template <class A>
void fields(A& a, LevelResult& r) {
  a(r.level, r.outcome, r.message, r.x, r.from_initial_state, r.steps, r.iterations, r.factorisations,
    r.analyses, r.flops, r.seconds, r.seconds_by_phase, r.decrement, r.force_residual, r.smallest_gap,
    r.contact_stiffness, r.load_stepping);
}

template <class A>
void fields(A& a, TangentialDisplacement& s) {
  a(s.contact, s.displacement.x(), s.displacement.y(), s.displacement.z());
}

template <class A, int size>
void fields(A& a, Eigen::Matrix<double, size, 1>& v) {
  for (double& component : v) a(component);
}

template <class A>
void fields(A& a, ObstaclePoint& p) {
  a(p.obstacle, p.vertices, p.weights, p.offset);
}

template <class A>
void fields(A& a, FrictionContact& c) {
  a(c.key, c.vertices, c.c, c.normal, c.force, c.touched);
}

template <class A>
void fields(A& a, LagDamping& d) {
  a(d.fraction, d.lag);
}

template <class A>
void fields(A& a, ContactMemory& m) {
  a(m.reference, m.tangential_displacements, m.candidates_begin, m.candidates_end, m.seconds_building,
    m.stiffness, m.damping);
}

template <class A>
void fields(A& a, Objective::PatternState& m) {
  a(m.extra.blocks, m.extra.idle, m.smooth_only, m.invalidated);
}

template <class A>
void fields(A& a, BlockCholesky::Analysis& m) {
  a(m.fixed, m.reused_ordering, m.ordering, m.ordering_flops, m.count);
}

template <class A>
void fields(A& a, IdleSteps::State& m) {
  a(m.steps, m.energy, m.residual);
}

template <class A>
void fields(A& a, CycleDetector::State& s) {
  a(s.steps, s.energies, s.residuals, s.returns);
}

template <class A>
void fields(A& a, Iterate::State& s) {
  a(s.residual_scale, s.limited_by);
}

template <class A>
void fields(A& a, ImplicitStep::State& s) {
  a(s.max_iterations);
}

template <class A>
void fields(A& a, StepController::State& s) {
  a(s.step_size, s.stall_count, s.stall_residual, s.backed_off, s.cycle_limit);
}

template <class A>
void fields(A& a, LineSearch::State& s) {
  a(s.step_length);
}

template <class A>
void fields(A& a, HessianModification::State& s) {
  a(s.blend);
}

template <class A>
void fields(A& a, FactorCache::State& s) {
  a(s.modification, s.pattern, s.analysis, s.age, s.fallback, s.fallback_updates, s.solver, s.shift,
    s.values);
}

template <class A>
void fields(A& a, NewtonStep::State& s) {
  a(s.implicit_step, s.controller, s.line_search, s.factor);
}

template <class A>
void fields(A& a, EquilibriumCheck::State& s) {
  a(s.decrements, s.initial_centroid, s.idle, s.cycle);
}

template <class A>
void fields(A& a, LoadStepper::State& s) {
  a(s.start, s.response, s.blocked_increments);
}

template <class A>
void fields(A& a, NewtonState& s) {
  a(s.so_far, s.iterate, s.step, s.check, s.dirichlet, s.load_stepper, s.contacts, s.switched_to_plain);
}

template <class A>
void fields(A& a, MethodState& s) {
  a(s.finished, s.level, s.under_way, s.seconds);
}

template <class A>
void fields(A& a, Cost& w) {
  a(w.seconds, w.iterations, w.flops);
}

template <class A>
void fields(A& a, Snapshot& f) {
  a(f.cost, f.x);
}

template <class A>
void fields(A& a, SnapshotRecorder::State& m) {
  a(m.spacing, m.seen, m.snapshots);
}

template <class A>
void fields(A& a, LevelSnapshots& f) {
  a(f.method, f.file, f.level, f.cost, f.iterations, f.energies, f.last, f.converged, f.checksum);
}

template <class A>
void fields(A& a, RecordedState& s) {
  a(s.method, s.level, s.x);
}

template <class A>
void fields(A& a, Recorder::State& s) {
  a(s.results, s.method, s.intersection_free, s.method_intersection_free, s.states, s.snapshots, s.measured,
    s.spent, s.last, s.overhead, s.iterations_bytes, s.log_bytes, s.last_load);
}

template <class A>
void fields(A& a, FileFingerprint& m) {
  a(m.path, m.bytes, m.checksum);
}

template <class A>
void fields(A& a, Checkpoint& c) {
  a(c.program, c.config, c.files, c.methods, c.method, c.all_converged, c.state, c.first_level, c.start,
    c.recorder);
}

namespace {

constexpr std::string_view magic = "drapestt";
/// Raise it with the first change after a release to what a checkpoint holds.
constexpr std::uint32_t format = 1;

struct Header {
  std::uint32_t format = drape::format, checksum = 0;
  std::uint64_t size = 0;
};

template <class A>
void fields(A& a, Header& h) {
  a(h.format, h.checksum, h.size);
}

std::filesystem::path newest(const std::filesystem::path& folder) { return folder / "checkpoint/state.bin"; }
std::filesystem::path previous(const std::filesystem::path& folder) {
  return folder / "checkpoint/previous.bin";
}

Checkpoint read(const std::filesystem::path& file) {
  try {
    return decode(read_file(file));
  } catch (const std::exception& fault) {
    throw std::runtime_error(file.string() + ": " + fault.what());
  }
}

}  // namespace

const std::size_t checkpoint_header_size = magic.size() + 16;

std::string encode(const Checkpoint& checkpoint) {
  ArchiveWriter body, whole;
  body(checkpoint);
  Header header;
  header.size = body.bytes.size();
  header.checksum = checksum_of(body.bytes);
  whole.bytes = magic;
  whole(header);
  return whole.bytes + body.bytes;
}

Checkpoint decode(std::string_view bytes) {
  if (!bytes.starts_with(magic.substr(0, std::min(bytes.size(), magic.size()))))
    throw std::runtime_error("is no checkpoint of drape");
  if (bytes.size() < checkpoint_header_size) throw std::runtime_error("is cut short");
  Header header;
  ArchiveReader(bytes.substr(magic.size()))(header);
  if (header.format != format)
    throw std::runtime_error("is a checkpoint of format " + std::to_string(header.format) +
                             ", but this drape reads format " + std::to_string(format) +
                             "; resume it with the drape that wrote it");
  bytes.remove_prefix(checkpoint_header_size);
  if (bytes.size() < header.size) throw std::runtime_error("is cut short");
  if (bytes.size() > header.size || checksum_of(bytes) != header.checksum)
    throw std::runtime_error("is damaged: its checksum does not fit");
  return decode_body(bytes);
}

Checkpoint decode_body(std::string_view bytes) {
  ArchiveReader reader(bytes);
  Checkpoint checkpoint;
  try {
    reader(checkpoint);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(std::string("is damaged: ") + fault.what());
  }
  if (!reader.at_end()) throw std::runtime_error("is damaged: it has data after its end");
  return checkpoint;
}

void save_checkpoint(const std::filesystem::path& folder, const Checkpoint& checkpoint) {
  const std::filesystem::path file = newest(folder), next = file.parent_path() / "next.bin";
  make_folder(file.parent_path());
  write_file(next, encode(checkpoint));
  sync_to_disk(next);
  std::error_code none;
  if (std::filesystem::exists(file, none)) rename_file(file, previous(folder));
  rename_file(next, file);
  sync_to_disk(file.parent_path());
}

Checkpoint load_checkpoint(const std::filesystem::path& folder, std::string& warning) {
  warning.clear();
  std::string faults;
  for (const auto& file : {newest(folder), previous(folder)}) {
    if (!std::filesystem::exists(file)) continue;
    try {
      Checkpoint checkpoint = read(file);
      if (!faults.empty()) warning = faults + "; going on from the checkpoint before it, " + file.string();
      return checkpoint;
    } catch (const std::exception& fault) {
      faults += (faults.empty() ? "" : "; ") + std::string(fault.what());
    }
  }
  if (faults.empty())
    throw std::runtime_error(folder.string() +
                             ": holds no checkpoint of a run; give the results folder of one that was "
                             "interrupted, or run the experiment again");
  throw std::runtime_error(faults + "; no checkpoint is whole: run the experiment again, as in drape run " +
                           (folder / "config.yaml").string() + " --out ANOTHER");
}

void remove_checkpoints(const std::filesystem::path& folder) {
  std::error_code error;
  for (const auto& file : {newest(folder), previous(folder)}) std::filesystem::remove(file, error);
}

}  // namespace drape
