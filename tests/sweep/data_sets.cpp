// The data set that is exported of a sweep of garments.

#include "core/numerics/mesh_files/io.h"
#include "tests/support/tube_dress.h"

using namespace drape;
using Catch::Contains;

TEST_CASE("a data set has the garments that pass, and names where the others are out of balance") {
  const Scratch folder;
  TubeDress{.columns = 8, .rows = 5, .facets = 24}.write(
      folder,
      "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
      "energies: [neo_hookean, {type: strain_limit, limit: 1.25}, hinge, gravity]\n");
  folder.write("s.yaml",  // the tube has to stretch by 12 % to be around the body
               "name: s\nbase: e.yaml\nablation: {grid: {energies.strain_limit.limit: [1.25, 1.05]}}\n");
  drape_ends("sweep s.yaml -o out -q", folder, 1);
  CHECK(drape_ends("export out --to set", folder, 1).out == "written: 1 of 2 to set/index.csv\n");

  std::istringstream index(text_of(folder / "set/index.csv"));
  std::string header, good, tight;
  std::getline(index, header) && std::getline(index, good) && std::getline(index, tight);
  CHECK_THAT(header, Catch::StartsWith("sweep,run,mesh,energies.strain_limit.limit,") &&
                         Contains(",intersections,force_residual"));
  CHECK_THAT(good, Catch::StartsWith("s,limit=1.25,limit=1.25.obj,1.25,") && Contains(",yes,converged,"));
  CHECK_THAT(tight, Catch::StartsWith("s,limit=1.05,,1.05,") && Contains(",NO,") &&
                        Contains("; the largest force is at "));

  const TriangleMesh garment = read_mesh(folder / "set/limit=1.25.obj");
  const nlohmann::json about = json_in(folder / "set/limit=1.25.json");
  CHECK((garment.piece_names == std::vector<std::string>{"front", "back"}));
  CHECK(garment.uv.rows() == garment.triangles.rows());
  CHECK(about["intersections"] == 0);
  CHECK(about["force_residual"].get<double>() < 1e-3);
  CHECK(about["experiment"]["material"]["membrane_modulus"] == 4e5);
  for (const char* field : {"stretch_warp", "stretch_weft", "ease", "contact_pressure"})
    CHECK(about["fields"][field].size() == static_cast<std::size_t>(garment.vertices.rows()));
  for (const nlohmann::json& piece : about["pieces"]) CHECK(piece["largest_stretch_weft"] < 25);
  CHECK(about["obstacles"] == nlohmann::json{"obstacle_0.obj"});
  CHECK(read_mesh(folder / "set/obstacle_0.obj").vertices.rows() == 48);
  CHECK_THAT(text_of(folder / "set/index.html"), Contains(" – drape</title>"));
  CHECK_THAT(drape_ends("export out --to set", folder, 2).err,
             Contains("set: exists already; name another folder"));
  drape_ends("export out --to set --overwrite", folder, 1);
  const std::string before = text_of(folder / "set/index.csv") + "\n";
  folder.write("set/index.csv", before);
  folder.write("set/index.html", "<p>mine</p>");  // nothing is written beside it
  CHECK_THAT(drape_ends("export out --to set --overwrite", folder, 2).err,
             Contains("set/index.html: is there already, and no report of drape; move it"));
  CHECK(text_of(folder / "set/index.csv") == before);
}

TEST_CASE("a data set replaces nothing of its sweep, and no variation's name is that of an obstacle") {
  const Scratch folder(
      "name: e\nlevels: 1\ncloth: {shape: square, side: 1, vertices: 25}\nstart: {translate: [0, 0, 0.5]}\n"
      "material: {density: 300, thickness: 5e-4, membrane_modulus: 4e5, bending_modulus: 1e5}\n"
      "energies: [neo_hookean, hinge]\ncontact: shapes\nobstacles: [{shape: sphere, radius: 0.3}]\n"
      "methods: {newton: {}}\n");
  folder.write(
      "s.yaml",
      "name: s\nbase: e.yaml\nablation: [{name: sweep}, {name: obstacle_0, set: {friction: 0.1}}]\n");
  drape_ends("sweep s.yaml -o out -q", folder);
  for (const std::string place : {"out", "out/runs/sweep"})
    CHECK_THAT(drape_ends("export out --overwrite --to " + place, folder, 2).err,
               Contains(place + ": is in the sweep's own folder"));
  CHECK(drape_ends("export out --to set", folder).out == "written: 2 of 2 to set/index.csv\n");
  CHECK(read_mesh(folder / "set/obstacle_0,seed_1.obj").vertices.rows() == 25);
  CHECK(read_mesh(folder / "set/obstacle_0.obj").vertices.rows() > 25);
}
