// One scene by STARK's quasistatic mode, for `compare`.
//
//     simulate SCENE OUT CODE    CODE: folder for the code that STARK generates and compiles
//
// SCENE has numbers: cloth's vertices, triangles, pins and the ball's vertices, triangles (0 without a ball);
// 1 to factorise matrices, 0 for conjugate gradients; density [kg/m²], thickness [m], Young's modulus [Pa],
// Poisson's ratio, hinge stiffness [J], d̂ [m]; largest step of a vertex [m], force residual at which to stop,
// CPU seconds after which to give up; then rest positions, start positions, triangles and pins of the cloth,
// positions and triangles of the ball. OUT gets Newton iterations, iterations of conjugate gradients, CPU
// seconds, force residual and the cloth's positions, of the last state.

#include <ctime>
#include <fstream>
#include <iostream>
#include <stark>

namespace {

using Points = std::vector<Eigen::Vector3d>;
using Triangles = std::vector<std::array<int, 3>>;

Points read_points(std::istream& in, int count) {
  Points points(count);
  for (auto& p : points) in >> p.x() >> p.y() >> p.z();
  return points;
}

Triangles read_triangles(std::istream& in, int count) {
  Triangles triangles(count);
  for (auto& t : triangles) in >> t[0] >> t[1] >> t[2];
  return triangles;
}

double cpu_seconds() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

}  // namespace

int main(int, char** words) {
  std::ifstream in(words[1]);
  int vertices, triangle_count, pin_count, ball_vertices, ball_triangle_count, factorises;
  in >> vertices >> triangle_count >> pin_count >> ball_vertices >> ball_triangle_count >> factorises;
  double density, thickness, modulus, poisson_ratio, hinge, dhat, step_cap, tolerance, limit;
  in >> density >> thickness >> modulus >> poisson_ratio >> hinge >> dhat >> step_cap >> tolerance >> limit;
  const Points rest = read_points(in, vertices), start = read_points(in, vertices);
  const Triangles triangles = read_triangles(in, triangle_count);
  std::vector<int> pins(pin_count);
  for (int& pin : pins) in >> pin;
  const Points ball = read_points(in, ball_vertices);
  const Triangles ball_triangles = read_triangles(in, ball_triangle_count);
  if (!in) return std::cerr << words[1] << ": too short\n", 1;

  stark::Settings settings;
  settings.output.simulation_name = "scene";
  settings.output.output_directory = settings.output.codegen_directory = words[3];
  settings.output.enable_frame_writes = false;
  settings.execution.n_threads = 1;
  settings.simulation.init_frictional_contact = ball_vertices > 0;
  // As its example of quasistatics has it. Its unknowns are velocities; with steps of 1 s they are
  // displacements.
  settings.simulation.max_time_step_size = 1;
  settings.newton.projection_mode = symx::ProjectionToPD::ProjectedNewton;
  settings.newton.project_to_pd_use_mirroring = true;
  settings.newton.linear_solver = factorises ? symx::LinearSolver::DirectLLT : symx::LinearSolver::BDPCG;
  settings.newton.step_cap = step_cap;
  settings.newton.step_tolerance = 0;
  settings.newton.residual_tolerance_abs = 0;  // the residual's function below ends the run
  settings.newton.bailout_residual = 0;
  stark::Simulation simulation(settings);

  const auto& parts = *simulation.deformables;
  const auto cloth = parts.point_sets->add(rest);
  stark::EnergyLumpedInertia::Params inertia;
  inertia.density = density;
  inertia.quasistatic = true;
  parts.lumped_inertia->add(cloth, triangles, inertia);
  stark::EnergyTriangleStrain::Params membrane;
  membrane.elasticity_only = true;
  membrane.thickness = thickness;
  membrane.youngs_modulus = modulus;
  membrane.poissons_ratio = poisson_ratio;
  parts.triangle_strain->add(cloth, triangles, membrane);
  stark::EnergyDiscreteShells::Params bending;
  bending.stiffness = hinge;
  parts.discrete_shells->add(cloth, triangles, bending);
  auto moved = cloth;
  for (int i = 0; i < vertices; ++i) moved.set_position(i, start[i]);
  const auto held = stark::EnergyPrescribedPositions::Params().set_stiffness(1e6);
  parts.prescribed_positions->add(cloth, pins, held);
  if (ball_vertices > 0) {
    auto& contact = *simulation.interactions->contact;
    const auto half = stark::ContactParams().set_contact_thickness(dhat / 2);
    contact.add_triangles(cloth, triangles, half);
    stark::PrescribedSurface::Params solid;
    solid.prescribed = held;
    solid.contact = half;
    simulation.presets->deformables->add_prescribed_surface("", ball, ball_triangles, solid);
  }

  Eigen::VectorXd weight = Eigen::VectorXd::Zero(vertices);
  for (const auto& t : triangles)
    for (const int i : t)
      weight[i] += density * 9.81 / 6 * (rest[t[1]] - rest[t[0]]).cross(rest[t[2]] - rest[t[0]]).norm();
  for (const int pin : pins) weight[pin] = 0;
  double begin = 0, residual = 0;
  int evaluations = 0;
  simulation.get_logger().add("cg_iterations", 0);  // STARK adds to it
  const auto write_state = [&] {
    std::ofstream out(words[2]);
    out.precision(17);
    out << evaluations - 1 << ' ' << simulation.get_logger().get_int("cg_iterations") << ' '
        << cpu_seconds() - begin << ' ' << residual << '\n';
    for (int i = 0; i < vertices; ++i)
      out << parts.point_sets->get_x1(cloth.get_global_index(i), simulation.get_time_step_size()).transpose()
          << '\n';
  };
  // Called with the gradient before each iteration.
  simulation.get_stark().callbacks->newton->set_residual([&](Eigen::VectorXd& gradient) {
    if (evaluations++ == 0) begin = cpu_seconds();  // the code is compiled by now
    Eigen::Map<Eigen::Matrix3Xd> forces(gradient.data(), 3, vertices);
    double sum = 0;
    for (int i = 0; i < vertices; ++i)
      if (weight[i] > 0) sum += forces.col(i).squaredNorm();
    const double norm = std::sqrt(sum);
    residual = norm / (weight.norm() * simulation.get_time_step_size());
    if (residual < tolerance || cpu_seconds() - begin > limit) {
      write_state();
      std::_Exit(0);
    }
    return norm;
  });
  while (true)
    simulation.run_one_time_step();  // again, where STARK wants to: with a stiffer contact or a smaller step
}
