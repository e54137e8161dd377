#include <benchmark/benchmark.h>

#include <cmath>
#include <concepts>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>

#include "benchmarks/measure.h"
#include "core/app/files/yaml_file.h"
#include "core/kernel/interfaces/energy.h"
#include "core/kernel/interfaces/level.h"
#include "core/kernel/plugin/make.h"
#include "core/numerics/elements/element_energy.h"
#include "core/numerics/patterns/generate.h"
#include "plugins/energy/midedge_bending/bound_midedge_bending.h"
#include "tests/support/unregistered.h"
// After it:
#include "plugins/energy/hinge/hinge.cpp"
#include "plugins/energy/neo_hookean/neo_hookean.cpp"
#include "plugins/energy/quadratic_bending/quadratic_bending.cpp"
#include "plugins/energy/stvk/stvk.cpp"

// Elements of a square of 313² vertices, 195K triangles and 293K hinges, wrinkled and noisy enough that most
// of their Hessians are indefinite. Arguments: threads. "per_element" is wall time over elements.

using namespace drape;

namespace {

using NeoHookean = MembraneFormula<formulas::neo_hookean>;
using Stvk = MembraneFormula<formulas::stvk>;
using Hinge = FoldFormula<formulas::hinge>;

struct Cloth {
  Level level;
  Positions x;

  /// The rest shape's inner vertices are moved by up to `jitter` cells.
  explicit Cloth(int n, double jitter = 0)
      : level(Level::of(0, jittered(n, jitter))), x(level.rest.vertices) {
    std::mt19937 random(1);
    std::normal_distribution<double> noise(0, 0.15 / (n - 1));
    for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += noise(random);
    for (int i = 0; i < x.rows(); ++i) x(i, 2) += 0.05 * std::sin(8 * x(i, 0)) * std::cos(9 * x(i, 1));
  }

  static TriangleMesh jittered(int n, double jitter) {
    TriangleMesh mesh = grid({1, 1}, n, n, Diagonals::one_way);
    std::mt19937 random(2);
    std::uniform_real_distribution<double> offset(-jitter / (n - 1), jitter / (n - 1));
    for (int j = 1; j + 1 < n && jitter > 0; ++j)
      for (int i = 1; i + 1 < n; ++i)
        for (int c = 0; c < 2; ++c) mesh.vertices(i + n * j, c) += offset(random);
    return mesh;
  }
};

const Cloth& cloth() {
  static const Cloth made(313);
  return made;
}

// Stand for midedge_bending in place of an energy's class: on the cloth, where all triangles are alike, and
// on one whose triangles all differ.
struct MidedgeAlike {};
struct MidedgeIrregular {};

// Stand for the plugin `formula` with the law of a compiled one.
struct NeoHookeanFormula {
  static constexpr const char* yaml =
      "{type: formula, where: {l: log(J)}, density: \"thickness*(mu*(g11 + g22 - l) + lambda/2*l^2)\"}";
};
struct StvkFormula {
  static constexpr const char* yaml =
      "{type: formula, density: \"thickness*(mu*(g11^2 + g22^2 + 2*g12^2) + lambda/2*(g11 + g22)^2)\"}";
};
struct HingeFormula {
  static constexpr const char* yaml = "{type: formula, per: hinge, energy: \"3*k*length^2/area*bend^2\"}";
};

std::unique_ptr<BoundEnergy> loaded_energy(const std::string& yaml, const Level& level) {
  ConfigErrors errors;
  const ConfigNode node = parse_yaml("energy: " + yaml, "benchmark", errors);
  const auto energy = make_from<Energy>(all_plugins(), *node.find("energy"), errors);
  if (!energy) throw std::runtime_error(errors.front().text());
  return energy->bind(level, Material());
}

template <class Kernel>
const Cloth& cloth_of() {
  return cloth();
}
template <>
const Cloth& cloth_of<MidedgeIrregular>() {
  static const Cloth made(313, 0.2);
  return made;
}

template <class Kernel>
const BoundEnergy& energy() {
  const Level& level = cloth_of<Kernel>().level;
  if constexpr (std::derived_from<Kernel, Energy>) {
    static const auto made = Kernel({}).bind(level, Material());
    return *made;
  } else if constexpr (requires { Kernel::yaml; }) {
    static const auto made = loaded_energy(Kernel::yaml, level);
    return *made;
  } else {
    static const BoundMidedgeBending made(level, ShapeOperators::of(level, Material(), 0.02),
                                          BendingFriction());
    return made;
  }
}

void finish(benchmark::State& state, double elements) {
  set_thread_count(0);
  state.counters["per_element"] = benchmark::Counter(
      elements, benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

template <class Kernel>
void value(benchmark::State& state) {
  const BoundEnergy& e = energy<Kernel>();
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(e.value(cloth_of<Kernel>().x));
  finish(state, e.stencils().rows());
}

template <class Kernel>
void gradient(benchmark::State& state) {
  const BoundEnergy& e = energy<Kernel>();
  Positions g = Positions::Zero(cloth_of<Kernel>().x.rows(), 3);
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(e.add_gradient(cloth_of<Kernel>().x, g));
  finish(state, e.stencils().rows());
}

template <class Kernel, Projection projection>
void hessian(benchmark::State& state) {
  const BoundEnergy& e = energy<Kernel>();
  BlockMatrix matrix(BlockPattern::of(cloth_of<Kernel>().level.vertex_count(), {e.stencils()}));
  const BlockSlots slots(*matrix.pattern, e.stencils());
  BlockSink sink = slots.sink(matrix);
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    e.add_hessian(cloth_of<Kernel>().x, projection, sink);
    benchmark::ClobberMemory();
  }
  finish(state, e.stencils().rows());
}

void shell_gradient(benchmark::State& state) {
  Positions g = Positions::Zero(cloth().x.rows(), 3);
  const BoundEnergy &membrane = energy<NeoHookean>(), &bending = energy<Hinge>();
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    g.setZero();
    benchmark::DoNotOptimize(membrane.add_gradient(cloth().x, g) + bending.add_gradient(cloth().x, g));
  }
  finish(state, cloth().level.vertex_count());
}

void shell_hessian(benchmark::State& state) {
  const BoundEnergy &membrane = energy<NeoHookean>(), &bending = energy<Hinge>();
  BlockMatrix matrix(
      BlockPattern::of(cloth().level.vertex_count(), {membrane.stencils(), bending.stencils()}));
  const BlockSlots membrane_slots(*matrix.pattern, membrane.stencils());
  const BlockSlots bending_slots(*matrix.pattern, bending.stencils());
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) {
    matrix.set_zero();
    BlockSink membrane_sink = membrane_slots.sink(matrix), bending_sink = bending_slots.sink(matrix);
    membrane.add_hessian(cloth().x, Projection::clamp, membrane_sink);
    bending.add_hessian(cloth().x, Projection::clamp, bending_sink);
    benchmark::ClobberMemory();
  }
  finish(state, cloth().level.vertex_count());
}

void block_pattern(benchmark::State& state) {
  const std::vector<Stencils> stencils = {energy<NeoHookean>().stencils(), energy<Hinge>().stencils()};
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) benchmark::DoNotOptimize(BlockPattern::of(cloth().level.vertex_count(), stencils));
  finish(state, cloth().level.vertex_count());
}

void block_slots(benchmark::State& state) {
  const std::vector<Stencils> stencils = {energy<NeoHookean>().stencils(), energy<Hinge>().stencils()};
  const auto pattern = BlockPattern::of(cloth().level.vertex_count(), stencils);
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state)
    for (const Stencils& s : stencils) benchmark::DoNotOptimize(BlockSlots(*pattern, s));
  finish(state, cloth().level.vertex_count());
}

void parallel_launch(benchmark::State& state) {
  set_thread_count(static_cast<int>(state.range(0)));
  for (auto _ : state) parallel_for(8, 1, [](int begin, int) { benchmark::DoNotOptimize(begin); });
  finish(state, 1);
}

}  // namespace

#define DRAPE_THREADS Unit(benchmark::kMillisecond)->Arg(1)->Arg(2)->UseRealTime()

BENCHMARK(shell_gradient)->DRAPE_THREADS;
BENCHMARK(shell_hessian)->DRAPE_THREADS;
#define DRAPE_KERNEL(Kernel)                                             \
  BENCHMARK_TEMPLATE(value, Kernel)->DRAPE_THREADS;                      \
  BENCHMARK_TEMPLATE(gradient, Kernel)->DRAPE_THREADS;                   \
  BENCHMARK_TEMPLATE(hessian, Kernel, Projection::none)->DRAPE_THREADS;  \
  BENCHMARK_TEMPLATE(hessian, Kernel, Projection::clamp)->DRAPE_THREADS; \
  BENCHMARK_TEMPLATE(hessian, Kernel, Projection::absolute)->DRAPE_THREADS
DRAPE_KERNEL(NeoHookean);
DRAPE_KERNEL(NeoHookeanFormula);
DRAPE_KERNEL(Stvk);
DRAPE_KERNEL(StvkFormula);
DRAPE_KERNEL(Hinge);
DRAPE_KERNEL(HingeFormula);
DRAPE_KERNEL(QuadraticBending);
DRAPE_KERNEL(MidedgeAlike);
DRAPE_KERNEL(MidedgeIrregular);
BENCHMARK(block_pattern)->DRAPE_THREADS;
BENCHMARK(block_slots)->DRAPE_THREADS;
BENCHMARK(parallel_launch)->Unit(benchmark::kMicrosecond)->Arg(1)->Arg(2)->UseRealTime();

BENCHMARK_MAIN();
