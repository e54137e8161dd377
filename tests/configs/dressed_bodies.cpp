// Bodies that are open: one in every kind of file, unit and axis that bodies come in, and one with cut limbs.

#include <iomanip>
#include <map>
#include <sstream>

#include "core/numerics/mesh/mesh_faults.h"
#include "core/numerics/mesh_files/io.h"
#include "tests/support/solve.h"
#include "tests/support/tube_dress.h"

using namespace drape;

namespace {

/// A body's file, for a mesh in metres with z up.
struct Form {
  std::string file, keys;
  double unit = 1;  ///< [m]
  bool y_up = false;

  Positions coordinates(const Positions& x) const {
    Positions own = x / unit;
    if (y_up)
      for (auto row : own.rowwise()) row = Eigen::RowVector3d(row[0], row[2], -row[1]);
    return own;
  }

  std::string text(const TriangleMesh& body) const {
    const Positions x = coordinates(body.vertices);
    std::ostringstream out;
    out << std::setprecision(17);
    const auto point = [&](int v) -> std::ostream& {
      return out << x(v, 0) << " " << x(v, 1) << " " << x(v, 2) << "\n";
    };
    const bool ply = file.ends_with(".ply"), stl = file.ends_with(".stl"), off = file.ends_with(".off");
    if (ply)
      out << "ply\nformat ascii 1.0\nelement vertex " << x.rows()
          << "\nproperty double x\nproperty double y\nproperty double z\nelement face "
          << body.triangles.rows() << "\nproperty list uchar int vertex_indices\nend_header\n";
    if (stl) out << "solid body\n";
    if (off) out << "OFF\n" << x.rows() << " " << body.triangles.rows() << " 0\n";
    for (int v = 0; v < x.rows() && !stl; ++v) out << (ply || off ? "" : "v "), point(v);
    for (const auto& t : body.triangles.rowwise()) {
      if (stl) {
        out << "facet normal 0 0 0\nouter loop\n";
        for (const int v : t) out << "vertex ", point(v);
        out << "endloop\nendfacet\n";
      } else if (ply || off) {
        out << "3 " << t[0] << " " << t[1] << " " << t[2] << "\n";
      } else {
        out << "f " << t[0] + 1 << " " << t[1] + 1 << " " << t[2] + 1 << "\n";
      }
    }
    if (stl) out << "endsolid body\n";
    return out.str();
  }
};

/// The number of loops in which a surface ends.
int border_loops(const TriangleMesh& mesh) {
  std::map<int, int> next;
  for (const int half : border_half_edges(mesh.triangles, static_cast<int>(mesh.vertices.rows()))) {
    const auto corners = mesh.triangles.row(half / 3);
    next[corners[(half + 1) % 3]] = corners[(half + 2) % 3];
  }
  int loops = 0;
  for (; !next.empty(); ++loops)
    for (auto at = next.begin(); at != next.end();) {
      const int to = at->second;
      next.erase(at);
      at = next.find(to);
    }
  return loops;
}

/// Writes a garment of this tree on a made body, with its arms, into a folder.
void write_dressed(const Scratch& folder, const std::string& body, const std::string& pattern,
                   double edge_length, int levels) {
  const std::filesystem::path garments = folders::source() / "configs/garments";
  const Ended made =
      Command((garments / "make_body").string() + " --form " + body + " --cell 0.03 body.obj", folder.path)
          .wait();
  INFO(made.err);
  REQUIRE(made.exit_code == 0);
  folder.write(
      "e.yaml",
      "name: garment\nlevels: " + std::to_string(levels) + "\ncloth: {shape: pattern, file: " +
          (garments / (pattern + ".yaml")).string() + ", edge_length: " + std::to_string(edge_length) +
          "}\nmaterial: {density: 300, thickness: 4e-4, membrane_modulus: 8e5, "
          "bending_modulus: 2e5}\nenergies: [neo_hookean, hinge, gravity]\ncontact: {type: ipc, dhat: "
          "0.002}\nfriction: 0.4\ndress: {body: body.obj, up: y}\nmethods: {pcs: {}}\nmetrics: []\n");
}

}  // namespace

TEST_CASE("An open body has the same energies from every kind of file, in any unit and with any axis up") {
  const TubeDress tube{.columns = 8, .rows = 5, .facets = 24};
  const Scratch folder;
  tube.write(folder,
             "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
             "energies: [neo_hookean, hinge, gravity]\n");
  const TriangleMesh body = read_mesh((folder / "body.obj").string());
  std::optional<Positions> start;
  Positions worn;
  double barrier = 0;
  std::vector<std::pair<std::string, double>> energies;
  for (const Form& form : {Form{"body.obj", ""},
                           {"mm.obj", ", unit: mm", 1e-3},
                           {"y.obj", ", up: y", 1, true},
                           {"cm_y.ply", ", unit: cm, up: y", 0.01, true},
                           {"inch.stl", ", unit: inch", 0.0254},
                           {"y.stl", ", up: y", 1, true},
                           {"mm.off", ", unit: mm", 1e-3}}) {
    INFO(form.file);
    folder.write(form.file, form.text(body));
    const auto scene = scene_of(experiment_in(
        folder / "e.yaml", {{"dress", "{body: " + (folder / form.file).string() + form.keys + "}"}}));
    const LevelModel& model = *scene->models[0];
    if (!start) start = scene->starts[0];
    CHECK((scene->starts[0] - *start).cwiseAbs().maxCoeff() < 1e-9);
    const auto barrier_at = [&](const Positions& x) {
      return model.contacts().at(0)->build_candidates(x, x)->build_collisions(x)->value(x);
    };
    if (worn.rows() == 0) {  // around the body, and narrower by a hundredth until it is within reach
      worn = *start;
      worn.leftCols(2) *= 3;
      while (barrier_at(worn) == 0) worn.leftCols(2) *= 0.99;
    }
    CHECK(model.contacts().at(0)->intersections(worn).empty());
    const double own = barrier_at(worn);
    if (barrier == 0) barrier = own, energies = model.energy_parts(worn);
    REQUIRE(barrier > 0);
    CHECK(own == Approx(barrier).epsilon(1e-9));
    const auto parts = model.energy_parts(worn);
    for (std::size_t k = 0; k < parts.size(); ++k)
      CHECK(parts[k].second == Approx(energies[k].second).epsilon(1e-9).margin(1e-15));
  }
}

TEST_CASE("A shirt is dressed on a made body that is cut at neck, wrists and thighs, beyond its ends") {
  const Scratch folder;
  write_dressed(folder, "--cut", "shirt", 0.05, 2);
  CHECK(border_loops(read_mesh((folder / "body.obj").string())) == 5);
  const Solved s = solved(experiment_in(folder / "e.yaml"));
  REQUIRE(s.levels.size() == 2);
  for (const LevelResult& level : s.levels) {
    INFO(level.message);
    CHECK(level.message.empty());
    CHECK(level.outcome == Outcome::converged);
    for (const auto& contact : s.scene->models[level.level]->contacts())
      CHECK(contact->intersections(level.x).empty());
    // Of cuffs and collar, beyond the wrists, which arms reach at 45 degrees, and beyond the neck.
    const auto farthest = [&](const Eigen::Vector3d& end, const Eigen::Vector3d& out) {
      return ((level.x.rowwise() - end.transpose()) * out.normalized()).maxCoeff();
    };
    for (const double side : {-1, 1}) CHECK(farthest({side * 0.548, 0.01, 0.947}, {side, 0, -1}) > 0.02);
    CHECK(farthest({0, 0, 1.44}, {0, 0, 1}) > 0.01);
  }
}

TEST_CASE("A pattern that is meshed finely starts smoothed over as long a way as a coarse one") {
  const Scratch folder;
  write_dressed(folder, "", "tshirt", 0.007, 1);
  const std::string remark = scene_of(experiment_in(folder / "e.yaml"))->garment->remark, key = "(smoothing ";
  CAPTURE(remark);
  CHECK(std::stod(remark.substr(remark.find(key) + key.size())) > 4);  // as far as coarse meshes need
}

TEST_CASE("A garment beside its body gets a warning, and one around it none") {
  const Scratch folder;
  const auto warnings = [&](double beside) {
    TubeDress tube{.columns = 8, .rows = 5, .facets = 24};
    tube.at.x() = beside;
    tube.write(folder,
               "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: "
               "1e5}\nenergies: [neo_hookean, hinge, gravity]\n");
    return drape_ends("check e.yaml", folder).err;
  };
  const std::string warning = "the garment encloses hardly anything of its body";
  CHECK_THAT(warnings(0), !Catch::Contains(warning));
  CHECK_THAT(warnings(0.23), Catch::Contains(warning));  // where the boxes of both still meet
}

TEST_CASE("a body of an animation is refused with what to dress in its place") {
  const Scratch folder;
  TubeDress().write(folder, "energies: [neo_hookean, hinge, gravity]\n");
  CHECK_THAT(
      refused_by(
          "check e.yaml --set 'dress={obstacle: body}' --set 'obstacles=[{name: body, animation: [body.obj, "
          "body.obj]}]'",
          folder.path),
      Catch::Contains(
          "\"contraction\", by which \"dress\" shrinks a body, needs a \"mesh\" without \"animation\"; "
          "dress the first frame as a mesh; what is dressed goes on in another run, by --resume with "
          "--set dress={}"));
}
