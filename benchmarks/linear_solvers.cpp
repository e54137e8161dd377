// newton.linear_solver: drape's supernodal factorisation, in single precision with conjugate gradients and in
// double precision, and CHOLMOD's with the BLAS that is loaded, on the Newton matrix of the finest level of
// configs/pinned_square.yaml and configs/sphere.yaml, at 25K and 98K vertices, with one thread and with all:
//
//     drape_bench_linear_solvers [RESULT.json]
//
// Debian's reference BLAS is slow: `apt-get install libopenblas0-pthread` replaces it. With one thread,
// CHOLMOD still copies and adds with up to four, unless OMP_THREAD_LIMIT=1.

#include <dlfcn.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "benchmarks/measure.h"
#include "core/kernel/threads/parallel.h"
#include "core/kernel/threads/stopwatch.h"
#include "core/numerics/linear_algebra/block_cholesky.h"
#include "core/numerics/model/objective.h"

using namespace drape;
using nlohmann::ordered_json;

namespace {

constexpr int repeats = 5;
/// A factorisation that takes longer [s] is measured once.
constexpr double long_factorisation = 5;

/// The library that gives CHOLMOD its matrix products, with its folder, which says whose it is.
std::string blas() {
  Dl_info info;
  void* const symbol = dlsym(RTLD_DEFAULT, "dgemm_");
  if (!symbol || !dladdr(symbol, &info)) return "unknown";
  const std::filesystem::path path = std::filesystem::canonical(info.dli_fname);
  return path.parent_path().filename() / path.filename();
}

/// The processor whose kernels OpenBLAS has taken; "" with another BLAS.
std::string openblas_kernels() {
  void* const symbol = dlsym(RTLD_DEFAULT, "openblas_get_corename");
  return symbol ? reinterpret_cast<const char* (*)()>(symbol)() : "";
}

/// OpenBLAS takes kernels without AVX-512 for a processor that is newer than itself. It reads the environment
/// as it is loaded, so the program begins again, with kernels that this processor's instructions allow.
void take_best_kernels(char** arguments) {
#ifdef __x86_64__
  const std::string kernels = openblas_kernels();
  const bool wide = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512vl") &&
                    __builtin_cpu_supports("avx512bw") && __builtin_cpu_supports("avx512dq");
  if (!wide || (kernels != "Haswell" && kernels != "Zen") || std::getenv("OPENBLAS_CORETYPE")) return;
  setenv("OPENBLAS_CORETYPE", "SkylakeX", 0);
  execv("/proc/self/exe", arguments);
#endif
}

/// Sets OpenBLAS's number of threads and returns it; 1 with another BLAS, which keeps its own.
int set_blas_threads(int threads) {
  void* const symbol = dlsym(RTLD_DEFAULT, "openblas_set_num_threads");
  if (!symbol) return 1;
  reinterpret_cast<void (*)(int)>(symbol)(threads);
  return threads;
}

/// The system of one Newton iteration.
struct System {
  const BlockMatrix& matrix;
  Eigen::VectorXd shift;  // [N/m]
  const std::vector<char>& fixed;
  Positions right;

  /// ‖(A + shift) x − b‖ / ‖b‖ on free vertices.
  double residual(const Positions& x) const {
    Positions r;
    matrix.multiply(x, r);
    double norm = 0, of_right = 0;
    for (Eigen::Index i = 0; i < x.rows(); ++i) {
      if (fixed[i]) continue;
      norm += (r.row(i) + shift[i] * x.row(i) - right.row(i)).squaredNorm();
      of_right += right.row(i).squaredNorm();
    }
    return std::sqrt(norm / of_right);
  }
};

/// One solver on one system.
class Measurement {
 public:
  Measurement(const char* name, LinearSolver solver) : name_(name), solver_(solver), cholesky_(solver) {}

  void analyse(const System& system) {
    std::vector<double> seconds;
    for (int i = 0; i < 3; ++i) {
      BlockCholesky fresh(solver_);
      const Stopwatch watch;
      fresh.analyse(system.matrix.pattern, system.fixed);
      seconds.push_back(watch.seconds());
    }
    analysis_seconds = median(seconds);
    cholesky_.analyse(system.matrix.pattern, system.fixed);
  }
  /// Forgets the times of another number of threads; factorises once, unmeasured, since memory is new.
  void warm_up(const System& system) {
    factorisations_.clear(), solves_.clear();
    repeatable = true;
    const Stopwatch watch;
    factorise(system);
    rounds_ = watch.seconds() > long_factorisation ? 1 : repeats;
    cholesky_.solve(system.right, first_);
    if (one_thread_.size() == 0) one_thread_ = first_;
  }
  void round(const System& system, int i) {
    if (i >= rounds_) return;
    Stopwatch watch;
    factorise(system);
    factorisations_.push_back(watch.seconds());
    watch = Stopwatch();
    cholesky_.solve(system.right, x_);
    solves_.push_back(watch.seconds());
    repeatable = repeatable && x_ == first_;
  }
  double factorisation_seconds() const { return median(factorisations_); }
  double solve_seconds() const { return median(solves_); }
  double flops() const { return cholesky_.flops(); }

  ordered_json row(const System& system) const {
    const double gflops = flops() / factorisation_seconds() * 1e-9, residual = system.residual(x_);
    std::printf(
        "  %-10s analysis %8.3f s   factorisation %9.4f s  %6.1f GFlop/s   solve %8.4f s   "
        "residual %.0e   same bits again: %s, with other threads: %s\n",
        name_, analysis_seconds, factorisation_seconds(), gflops, solve_seconds(), residual,
        repeatable ? "yes" : "NO", first_ == one_thread_ ? "yes" : "NO");
    return {{"analysis_seconds", analysis_seconds}, {"factorisation_seconds", factorisation_seconds()},
            {"gflops_per_second", gflops},          {"solve_seconds", solve_seconds()},
            {"relative_residual", residual},        {"rounds", rounds_},
            {"same_bits_again", repeatable},        {"same_bits_as_with_one_thread", first_ == one_thread_}};
  }

  double analysis_seconds = 0;
  bool repeatable = true;  ///< every round gave the same bits

 private:
  void factorise(const System& system) {
    if (!cholesky_.factorise(system.matrix, system.shift))
      throw std::runtime_error(std::string(name_) + ": the projected matrix is not positive definite");
  }

  const char* name_;
  LinearSolver solver_;
  BlockCholesky cholesky_;
  int rounds_ = repeats;
  std::vector<double> factorisations_, solves_;
  Positions first_, one_thread_, x_;
};

void compare(const System& system, const ordered_json& head, ordered_json& rows) {
  Measurement mixed("mixed", LinearSolver::mixed), supernodal("supernodal", LinearSolver::supernodal),
      cholmod("cholmod", LinearSolver::cholmod);
  for (Measurement* measurement : {&mixed, &supernodal, &cholmod}) measurement->analyse(system);
  for (const int threads : std::set<int>{1, core_count()}) {
    set_thread_count(threads);
    const int blas_threads = set_blas_threads(threads);
    for (Measurement* measurement : {&mixed, &supernodal, &cholmod}) measurement->warm_up(system);
    for (int i = 0; i < repeats; ++i)  // in turn: the machine's speed drifts
      for (Measurement* measurement : {&mixed, &supernodal, &cholmod}) measurement->round(system, i);
    std::printf("%s, %d vertices, %.1f GFlop, %d threads (BLAS %d)\n",
                head["scene"].get<std::string>().c_str(), head["vertices"].get<int>(),
                supernodal.flops() * 1e-9, threads, blas_threads);
    ordered_json row = head;
    row["gflops"] = supernodal.flops() * 1e-9;
    row["threads"] = threads;
    row["blas_threads"] = blas_threads;
    row["mixed"] = mixed.row(system);
    row["supernodal"] = supernodal.row(system);
    row["cholmod"] = cholmod.row(system);
    row["mixed_over_supernodal"] = {
        {"factorisation", mixed.factorisation_seconds() / supernodal.factorisation_seconds()},
        {"solve", mixed.solve_seconds() / supernodal.solve_seconds()}};
    row["cholmod_over_supernodal"] = {
        {"analysis", cholmod.analysis_seconds / supernodal.analysis_seconds},
        {"factorisation", cholmod.factorisation_seconds() / supernodal.factorisation_seconds()},
        {"solve", cholmod.solve_seconds() / supernodal.solve_seconds()}};
    std::printf("  cholmod / supernodal: %s\n", row["cholmod_over_supernodal"].dump().c_str());
    std::fflush(stdout);
    rows.push_back(std::move(row));
  }
  set_thread_count(0);
}

/// Measures the matrix where the cascadic method's finest level is after a few iterations.
void measure(const std::string& scene_name, int levels, ordered_json& rows) {
  // From 40 vertices a side, 3 and 4 levels give 25K and 98K vertices.
  const Loaded loaded("../configs/" + scene_name + ".yaml", {{"cloth.columns", "40"},
                                                             {"cloth.rows", "40"},
                                                             {"levels", std::to_string(levels)},
                                                             {"newton.force_tolerance", "1e-2"}});
  const LevelModel& model = *loaded.scene->models.back();
  FirstIterations some(3, levels - 1);
  const LevelResult reached = method(*loaded.experiment, "cascadic").solve(*loaded.scene, some).back();
  if (reached.level != levels - 1) throw std::runtime_error(scene_name + ": " + reached.message);

  PlainObjective objective(model);
  objective.contacts().begin_step(reached.x);
  Positions gradient;
  objective.gradient(reached.x, gradient);
  const BlockMatrix& matrix = objective.matrix(reached.x, Projection::clamp);
  const System system{matrix, model.masses() / 0.01, model.fixed(), gradient};  // h = 0.1 s
  const int vertices = model.level().vertex_count();
  compare(system, {{"scene", scene_name}, {"vertices", vertices}, {"blocks", matrix.pattern->blocks()}},
          rows);
}

}  // namespace

int main(int argc, char** argv) try {
  take_best_kernels(argv);
  std::printf("BLAS: %s %s\n", blas().c_str(), openblas_kernels().c_str());
  ordered_json rows = ordered_json::array();
  for (const char* scene : {"pinned_square", "sphere"})
    for (const int levels : {3, 4}) measure(scene, levels, rows);
  if (argc > 1)
    write_record(argv[1], "linear_solvers", repeats, rows,
                 {{"blas", blas()}, {"blas_kernels", openblas_kernels()}});
  return 0;
} catch (const std::exception& error) {
  std::cerr << "error: " << error.what() << "\n";
  return 2;
}
