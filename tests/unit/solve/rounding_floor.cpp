#include "core/numerics/step/rounding_floor.h"

#include <catch2/catch.hpp>
#include <cmath>

#include "core/numerics/patterns/generate.h"
#include "core/numerics/solve/newton.h"
#include "core/numerics/solve/newton_state.h"
#include "tests/support/test_energies.h"
#include "tests/unit/solve/resumed.h"

using namespace drape;

namespace {

using Vector3 = Eigen::Vector3d;

/// Factors by which all forces, or the load, differ from the energy's.
struct Fault {
  double all = 1, load = 1;
};

/// ½ k (|x_a − x_b| − L)² along all edges and a constant force on every vertex: a stiff, narrow, hanging
/// strip.
class EdgeSprings : public NoEnergy {
 public:
  EdgeSprings(const TriangleMesh& rest, double k, Fault fault) : rest_(rest.vertices), k_(k), fault_(fault) {
    const Topology topology = Topology::of(rest.triangles, static_cast<int>(rest.vertices.rows()));
    for (int i = 0; i < rest_.rows(); ++i)
      for (const int j : topology.vertex_vertices.row(i))
        if (i < j) edges_.push_back({i, j});
  }

  double value(const Positions& x) const override {
    double sum = -(x * load_).sum();
    for (const auto& [a, b] : edges_) sum += 0.5 * k_ * std::pow(stretch<double>(x, a, b), 2);
    return sum;
  }
  double add_gradient(const Positions& x, Positions& g) const override {
    g += fault_.all * gradient<double>(x);
    g.rowwise() -= (fault_.load - 1) * load_.transpose();
    return value(x);
  }
  /// In any arithmetic, at positions in doubles.
  template <class T>
  Eigen::Matrix<T, Eigen::Dynamic, 3, Eigen::RowMajor> gradient(const Positions& x) const {
    Eigen::Matrix<T, Eigen::Dynamic, 3, Eigen::RowMajor> g =
        -load_.transpose().template cast<T>().replicate(x.rows(), 1);
    for (const auto& [a, b] : edges_) {
      const auto d = (x.row(a).template cast<T>() - x.row(b).template cast<T>()).eval();
      const auto force = (T(k_) * stretch<T>(x, a, b) * d / d.norm()).eval();
      g.row(a) += force;
      g.row(b) -= force;
    }
    return g;
  }
  Stencils stencils() const override {
    return Eigen::Map<const Stencils>(edges_[0].data(), std::ssize(edges_), 2);
  }
  void add_hessian(const Positions& x, Projection projection, BlockSink& sink) const override {
    for (int e = 0; e < static_cast<int>(edges_.size()); ++e) {
      const auto [a, b] = edges_[e];
      const Vector3 d = (x.row(a) - x.row(b)).transpose(), n = d.normalized();
      const double across = projection.map(k_ * stretch<double>(x, a, b) / d.norm());
      const Eigen::Matrix<double, 3, 3, Eigen::RowMajor> h = across * Eigen::Matrix3d::Identity() +
                                                             (k_ - across) * n * n.transpose(),
                                                         minus = -h;
      sink.add(e, 0, 0, h.data());
      sink.add(e, 0, 1, minus.data());
      sink.add(e, 1, 1, h.data());
    }
  }

 private:
  template <class T>
  T stretch(const Positions& x, int a, int b) const {
    return (x.row(a).cast<T>() - x.row(b).cast<T>()).norm() -
           (rest_.row(a).cast<T>() - rest_.row(b).cast<T>()).norm();
  }

  Positions rest_;
  double k_;
  Fault fault_;
  const Vector3 load_{1e-3, 0, 0};
  std::vector<std::array<int, 2>> edges_;
};

/// A strip of 1 m by 5 mm that hangs along x from its first column.
struct HangingStrip {
  static constexpr int columns = 41;
  Level level = Level::of(0, grid({1, 0.005}, columns, 2, Diagonals::one_way));
  const Positions& rest = level.rest.vertices;
  std::vector<DirichletVertex> pins = {{0, rest.row(0), 0}, {columns, rest.row(columns), 0}};
  EdgeSprings springs;
  std::vector<NamedEnergy> energies;
  std::unique_ptr<LevelModel> model;
  std::unique_ptr<PlainObjective> objective;

  explicit HangingStrip(double k, Fault fault = {})
      : springs(level.rest, k, fault), energies{{"springs", energy_of(springs)}} {}

  /// With a tolerance that is far too tight.
  LevelResult solve(NewtonForm form = NewtonForm::quasistatic) {
    return solve({.form = form, .max_steps = 400, .force_tolerance = 1e-13});
  }
  LevelResult solve(const NewtonParameters& p) {
    Observer silent;
    return solve(p, silent);
  }
  LevelResult solve(const NewtonParameters& p, Observer& observer, const NewtonState* from = nullptr) {
    model = std::make_unique<LevelModel>(level, Material(), energies, pins);
    objective = std::make_unique<PlainObjective>(*model);
    return minimise(*objective, from ? Positions() : rest, p, {Stopwatch(), observer, false, {}, from});
  }
};

}  // namespace

TEST_CASE("The bound of a vertex sums the effects of its neighbours' round-off") {
  BlockMatrix h(BlockPattern::of(3, {Stencils(Eigen::RowVector2i(0, 1))}));
  for (int i = 0; i < 3; ++i)
    for (int c = 0; c < 3; ++c) h.block(h.pattern->find(i, i))[4 * c] = i + 1;
  h.block(h.pattern->find(0, 1))[1] = -10;
  Positions x(3, 3);
  x << 0, 0, 2, 3, 4, 0, 0, 1, 0;
  const double u = std::pow(2, -53), identity = std::sqrt(3.0);
  const Eigen::VectorXd bounds = rounding_bounds(h, x);
  CHECK(bounds[0] == Approx(u * (identity * 2 + 10 * 5)));
  CHECK(bounds[1] == Approx(u * (2 * identity * 5 + 10 * 2)));
  CHECK(bounds[2] == Approx(u * 3 * identity));

  Positions g = Positions::Zero(3, 3);
  g(0, 1) = 0.99 * bounds[0];
  g(1, 1) = 1;
  CHECK(rounding_floor(h, x, g, {0, 1, 0}).reached);
  CHECK(rounding_floor(h, x, g, {0, 1, 0}).norm == Approx(std::hypot(bounds[0], bounds[2])));
  CHECK(!rounding_floor(h, x, g, {0, 0, 0}).reached);
  g(0, 1) = std::nan("");
  CHECK(!rounding_floor(h, x, g, {0, 1, 0}).reached);
}

TEST_CASE("Steps are idle while neither energy nor residual falls") {
  IdleSteps idle;
  const auto after = [&](int steps, double energy, double residual) {
    for (int k = 0; k < steps; ++k) idle.note(energy, residual, 1e-12);
    return idle.many();
  };
  CHECK(!after(10, 1, 1e-3));
  CHECK(after(1, 1 + 1e-13, 0.7e-3));
  CHECK(!after(1, 1, 0.4e-3));  // the residual has halved
  CHECK(!after(9, 1, 0.4e-3));
  CHECK(!after(1, 1 - 2e-12, 0.4e-3));  // the energy has fallen
  CHECK(after(10, 1 - 2e-12, 0.4e-3));
  idle = {};
  CHECK(!after(10, 1 - 2e-12, 0.4e-3));
  for (int k = 0; k < 30; ++k) after(1, 1 - 1e-12 * k / 4, 1e-3);  // creeps: falls eventually
  CHECK(!idle.many());
  CHECK(!after(30, std::nan(""), 1e-3));
}

TEST_CASE("A strip at equilibrium up to round-off has converged to rounding") {
  for (const NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics})
    for (const double k : {1e4, 1e6, 1e8}) {
      HangingStrip strip(k);
      const LevelResult r = strip.solve(form);
      CAPTURE(int(form), k, r.steps, r.message);
      CHECK(r.outcome == Outcome::converged_to_rounding);
      CHECK(has_converged(r.outcome));
      CHECK_THAT(r.message,
                 Catch::StartsWith("the force residual is ") &&
                     Catch::Contains("above force_tolerance = 1e-13: round-off alone accounts for up to "));
      // Exact for the given positions.
      const Eigen::VectorXd bounds = rounding_bounds(strip.objective->matrix(r.x, Projection::none), r.x);
      const auto exact = strip.springs.gradient<long double>(r.x);
      for (int i = 0; i < r.x.rows(); ++i)
        if (i % HangingStrip::columns > 0) CHECK(exact.row(i).norm() <= 2 * bounds[i]);
      // And the strip is where it hangs: k is that of the whole width's springs.
      CHECK(r.x.col(0).maxCoeff() > 1);
    }
}

TEST_CASE("Round-off beyond the load leaves no equilibrium, nor does a pin out of reach there") {
  HangingStrip strip(1e18), pulled(1e18);
  const LevelResult r = strip.solve();
  CAPTURE(r.steps, r.message);
  CHECK(r.force_residual > 1);
  CHECK(r.outcome == Outcome::stalled);
  CHECK_THAT(r.message, Catch::Contains("round-off alone accounts for up to "));

  const int last = HangingStrip::columns - 1;
  pulled.pins.push_back({last, pulled.rest.row(last).transpose() + Vector3(0, 0, 0.1), 1});
  pulled.energies.push_back({"limit", energy_of(Limiter(0), EnergyRole::limit)});
  const LevelResult short_of_target = pulled.solve();
  CAPTURE(short_of_target.message);
  CHECK(short_of_target.outcome == Outcome::infeasible);
  CHECK(short_of_target.force_residual > 1);
  CHECK_THAT(short_of_target.message,
             Catch::Contains("pin 1 stopped 0.1 m short") && !Catch::Contains("at equilibrium"));
}

TEST_CASE("A level whose decrement alone is above its tolerance says so") {
  for (const int max_steps : {3, 400}) {
    const LevelResult r = HangingStrip(1e6).solve({.form = NewtonForm::statics,
                                                   .max_steps = max_steps,
                                                   .force_tolerance = 1e6,
                                                   .decrement_tolerance = 1e-30});
    INFO(r.message);
    CHECK(r.outcome != Outcome::converged);
    CHECK_THAT(r.message,
               Catch::Contains("above decrement_tolerance = 1e-30") && !Catch::Contains("force_tolerance"));
  }
}

TEST_CASE("A run that ends at the rounding floor can be resumed bit for bit from any state") {
  const NewtonParameters p{.max_steps = 400, .force_tolerance = 1e-13};
  KeepingObserver whole;
  whole.keeps_states = true;
  const LevelResult expected = HangingStrip(1e6).solve(p, whole);
  REQUIRE(expected.outcome == Outcome::converged_to_rounding);
  check_resumed(whole, expected, [&](const NewtonState& state, Observer& observer) {
    return HangingStrip(1e6).solve(p, observer, &state);
  });
}

TEST_CASE("A strip whose forces are not those of its energy has not converged to rounding") {
  for (const NewtonForm form : {NewtonForm::quasistatic, NewtonForm::statics})
    for (const Fault fault : {Fault{-1, 1}, Fault{1, 3}}) {
      const LevelResult r = HangingStrip(1e6, fault).solve(form);
      CAPTURE(int(form), fault.all, r.steps, r.message, r.force_residual);
      // Without inertia, the line search fails uphill.
      const bool uphill = form == NewtonForm::statics && fault.all < 0;
      CHECK(r.outcome == (uphill ? Outcome::stalled : Outcome::max_steps_reached));
      CHECK(r.force_residual > 0.1);
    }
}
