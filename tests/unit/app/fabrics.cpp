// Fabrics by name and from a file, and materials that do not fit together.

#include "core/app/experiment/fabrics.h"

#include <catch2/catch.hpp>

#include "core/app/report/compare.h"
#include "core/numerics/elements/orthotropic_stiffness.h"
#include "tests/support/solve.h"

using namespace drape;
using Catch::Contains;

namespace {

std::string with_material(const std::string& material) {
  return "name: fabric\nmaterial: {" + material +
         "}\nenergies: [woven, midedge_bending, gravity]\nmethods: {newton: {}}\n";
}

Material material_of(const std::string& material) {
  return experiment_from(with_material(material)).parameters.material;
}

/// Each material is refused with its message.
void check_refused(const std::vector<std::pair<std::string, std::string>>& materials) {
  for (const auto& [material, message] : materials) {
    INFO(material);
    CHECK_THROWS_WITH(material_of(material), Contains(message));
  }
}

/// The keys of a saved material, without the braces.
std::string saved_numbers(const ConfigNode& saved, const std::string& from, const std::string& to) {
  const std::string numbers = replaced(saved.find("material")->one_line(), from, to);
  return numbers.substr(1, numbers.size() - 2);
}

/// A file with fabrics of one's own.
struct OwnFabrics : Scratch {
  explicit OwnFabrics(const std::string& table) { write("own.csv", table); }
  std::string file() const { return (*this / "own.csv").string(); }
  std::string row(const std::string& name) const {
    return "fabric: {file: " + file() + ", row: " + name + "}";
  }
};

}  // namespace

TEST_CASE("every fabric of the table is a material with a source") {
  CHECK(fabric_names().size() >= 10);
  for (const std::string& name : fabric_names()) {
    INFO(name);
    ConfigErrors errors;
    const ConfigNode row = fabric_row(ConfigNode::of(name), std::nullopt, errors);
    CHECK(errors.empty());
    REQUIRE(row.find("source"));
    const Material m = material_of("fabric: " + name);
    CHECK(m.area_density() > 0.1);
    CHECK(m.area_density() < 0.4);
    // A bending length of 5 to 50 mm along warp.
    const double length = std::cbrt(plate_stiffness(m).strip(0) / (m.area_density() * standard_gravity));
    CHECK(length > 0.005);
    CHECK(length < 0.05);
  }
}

TEST_CASE("the fabrics of Wang et al. have the tension of the published files") {
  struct Published {
    const char* name;
    double c11, c12, c22, c33;  // the first row of "stretching" [N/m]
  };
  // ARCSim's materials/*.json, after the authors' page.
  for (const auto& [name, c11, c12, c22, c33] : {
           Published{"ivory-rib-knit", 42.871021, -0.234556, 65.166023, 83.175644},
           {"pink-ribbon-brown", 151.503906, 106.028160, 244.830673, 30.250183},
           {"white-dots-on-blk", 2002.08618, 0.345588, 2027.48559, 19.189022},
           {"navy-sparkle-sweat", 12.486332, -19.875324, 3.272434, 17.616289},
           {"camel-ponte-roma", 31.146198, -12.802702, 44.028667, 31.896357},
           {"gray-interlock", 16.593832, -14.695990, 34.477123, 36.860302},
           {"11oz-black-denim", 205.352005, 10.234077, 1013.88629, 53.387184},
           {"white-swim-solid", 47.971176, 6.834521, 104.615456, 60.773663},
           {"tango-red-jet-set", 43.067627, 54.373299, 171.424835, 14.314700},
           {"royal-target", 2016.55456, 9.170511, 2034.97644, 104.759674},
       }) {
    INFO(name);
    const Material m = material_of("fabric: " + std::string(name));
    const double contraction = std::pow(std::max(c12, 0.0), 2);
    REQUIRE((m.warp_stiffness && m.weft_stiffness && m.shear_stiffness));
    CHECK(*m.warp_stiffness == Approx(c11 - contraction / c22).epsilon(5e-4));
    CHECK(*m.weft_stiffness == Approx(c22 - contraction / c11).epsilon(5e-4));
    CHECK(*m.shear_stiffness == Approx(c33 / 2).epsilon(5e-4));
  }
}

TEST_CASE("what is written beside a fabric takes precedence, and the numbers are saved") {
  const Experiment e = experiment_from(with_material("fabric: gray-interlock, warp_bending: 3e-5"));
  const Material m = e.parameters.material;
  CHECK(m.area_density() == Approx(0.187));
  CHECK(m.warp_bending == 3e-5);
  CHECK(m.weft_bending == 14.27e-6);
  CHECK(m.poisson_ratio == Material().poisson_ratio);
  const ConfigNode* saved = e.resolved.find("material");
  CHECK(saved->find("weft_bending")->scalar == "1.427e-05");
  CHECK(saved->find("fabric")->kind == ConfigNode::Kind::null);
  CHECK(saved->find("from_fabric")->scalar == "gray-interlock");
  const Experiment again = experiment_from(to_yaml(e.resolved));
  CHECK(again.parameters.material == m);
  CHECK(to_yaml(again.resolved) == to_yaml(e.resolved));
}

TEST_CASE("a fabric beside the numbers that a run has saved gives nothing and is refused") {
  const ConfigNode saved = experiment_from(with_material("fabric: cotton")).resolved;
  check_refused(
      {{saved_numbers(saved, "fabric: null", "fabric: wool-lycra"),
        "\"fabric\" gives nothing: every number of wool-lycra is written beside it; leave out those "
        "that it is to give"}});
  const Experiment e = experiment_from(with_material("from_fabric: cotton, fabric: wool-lycra"));
  CHECK(e.resolved.find("material")->find("from_fabric")->scalar == "wool-lycra");
  // A name is no difference between two models.
  const ConfigNode named = experiment_from(with_material("fabric: gray-interlock")).resolved;
  const std::string numbers = saved_numbers(named, "from_fabric: gray-interlock", "from_fabric: null");
  const ConfigNode plain = experiment_from(with_material(numbers)).resolved;
  CHECK(differing_model_keys(named, plain).empty());
  CHECK(model_of(named) == model_of(plain));
}

TEST_CASE("a thickness beside a fabric keeps the sheet's mass and stiffness") {
  const OwnFabrics own(
      "name, density, thickness, membrane_modulus, bending_modulus, warp_stiffness, warp_bending\n"
      "measured, 500, 4e-4, 1e6, 2e6, , \nper volume, 500, , 1e6, 2e6, , \n"
      "per width, 500, 4e-4, , , 300, 2e-6\n");
  for (const std::string& fabric :
       {std::string("fabric: white-dots-on-blk"), std::string("fabric: cotton"),
        std::string("fabric: cotton-broad"), own.row("measured"), own.row("per width")}) {
    INFO(fabric);
    const Material usual = material_of(fabric), thick = material_of(fabric + ", thickness: 6e-4");
    CHECK(thick.thickness == 6e-4);
    CHECK(thick.area_density() == Approx(usual.area_density()));
    for (const double angle : {0.0, 0.8, 1.5}) {
      CHECK(membrane_stiffness(thick).strip(angle) == Approx(membrane_stiffness(usual).strip(angle)));
      CHECK(plate_stiffness(thick).strip(angle) == Approx(plate_stiffness(usual).strip(angle)));
    }
    CHECK(bending_stiffness(thick) == Approx(bending_stiffness(usual)));
  }
  // Numbers of the bulk whose thickness the source does not give, and what is written beside the fabric.
  const auto numbers = [](const std::string& material) {
    const Material m = material_of(material + ", thickness: 6e-4");
    return Eigen::Vector3d(m.density, m.membrane_modulus, m.bending_modulus);
  };
  CHECK(numbers(own.row("per volume")) == Eigen::Vector3d(500, 1e6, 2e6));
  CHECK(numbers("fabric: cotton, density: 400, membrane_modulus: 7e4, bending_modulus: 9e4") ==
        Eigen::Vector3d(400, 7e4, 9e4));
}

TEST_CASE("a modulus beside a fabric replaces its stiffness by direction, and the other way round") {
  const OwnFabrics own(
      "name, mass, warp_stiffness, weft_stiffness, shear_stiffness, warp_bending, weft_bending\n"
      "twill, 0.3, 300, 200, 40, 2e-5, 9e-6\n");
  const std::string row = own.row("twill");
  const Material bent = material_of("fabric: white-dots-on-blk, bending_modulus: 9e4");
  CHECK(bent.bending_modulus == 9e4);
  CHECK_FALSE((bent.warp_bending || bent.weft_bending || bent.bias_bending));
  const Material stretched = material_of(row + ", membrane_modulus: 7e4, thickness: 6e-4");
  CHECK(stretched.membrane_modulus == 7e4);
  CHECK_FALSE((stretched.warp_stiffness || stretched.weft_stiffness));
  CHECK(stretched.shear_stiffness == 40);
  CHECK(stretched.warp_bending == 2e-5);
  const Material directed =
      material_of("fabric: cotton, warp_bending: 3e-5, warp_stiffness: 50, thickness: 6e-4");
  CHECK(directed.warp_bending == 3e-5);
  CHECK(directed.warp_stiffness == 50);
  CHECK(directed.bending_modulus == Material().bending_modulus);
  CHECK(directed.membrane_modulus == Material().membrane_modulus);
}

TEST_CASE("isotropic energies take the mean of warp and weft") {
  Material m;
  m.thickness = 1e-3;
  m.warp_stiffness = 100, m.weft_stiffness = 400, m.warp_bending = 1e-6, m.weft_bending = 4e-6;
  CHECK(m.mean_membrane_modulus() == Approx(200 / 1e-3));
  CHECK(m.mean_bending_modulus() == Approx(12 * 2e-6 / 1e-9));
}

TEST_CASE("a row of a file, whose faults are named") {
  const OwnFabrics own(
      "name, mass, thickness, warp_bending, weft_bending\ntwill, 0.3, 5e-4, 2e-5, 9e-6\nlight, , , 1e-6,\n"
      "worse, 0.1, 5e-4, stiff, 1e-6\nbare, 0.2, 5e-4, , 1e-6\nbuoyant, -0.2, 5e-4, 1e-6, 1e-6\n");
  const Material m = material_of(own.row("twill"));
  CHECK(m.density == Approx(600));
  CHECK(m.warp_bending == 2e-5);
  CHECK(m.weft_bending == 9e-6);
  CHECK_FALSE(m.bias_bending);
  CHECK(material_of(own.row("1")) == m);
  // As spreadsheets save it.
  const std::string saved = "\xEF\xBB\xBF" + text_of(own.file());
  std::string by_semicolons = saved;
  std::ranges::replace(by_semicolons, ',', ';');
  for (const std::string& text : {by_semicolons, saved}) {
    own.write("own.csv", text);
    CHECK(material_of(own.row("twill")) == m);
    CHECK(drape_ends("fabric --file own.csv", own).out == "twill\nlight\nworse\nbare\nbuoyant\n");
  }
  const Experiment e = experiment_from(with_material(own.row("twill")));
  CHECK(e.parameters.material.from_fabric == "{file: " + own.file() + ", row: twill}");
  CHECK(to_yaml(experiment_from(to_yaml(e.resolved)).resolved) == to_yaml(e.resolved));
  // The mass is that of the sheet, and a density beside it is not read.
  own.write("own.csv",
            "\"name\",use,\"mass\",density,thickness,warp_bending,weft_bending\n"
            "twill,\"shirt, \"\"fine\"\"\",0.3,\"700\",5e-4,2e-5,9e-6\n");
  CHECK(material_of(own.row("twill")) == m);
  // Rows of ClothDrapeTester's table are read by number.
  own.write("own.csv",
            "density[kg.m-2], linear warp[SI*1e9], linear weft[SI*1e9], linear diag[SI*1e9], nonlinear "
            "warp[SI*1e12]\n0.2, 9000, 7000, 4000, -44000\n");
  CHECK(fabric_names(own / "own.csv") == std::vector<std::string>{"1"});
  const Material tested = material_of(own.row("1"));
  CHECK(tested.area_density() == Approx(0.2));
  CHECK(*tested.warp_bending == Approx(9e-6));
  CHECK(*tested.weft_bending == Approx(7e-6));
  CHECK(*tested.bias_bending == Approx(4e-6));
}

TEST_CASE("a table of tabs and of capital heads is read, and one that says something twice is refused") {
  const OwnFabrics own("NAME\tMass\tThickness\tWARP_BENDING\ntwill, blue\t0.3\t5e-4\t2e-5\n");
  const Material m = material_of(own.row("\"twill, blue\""));
  CHECK(m.area_density() == Approx(0.3));
  CHECK(m.warp_bending == 2e-5);
  CHECK(fabric_names(own / "own.csv") == std::vector<std::string>{"twill, blue"});
  own.write("own.csv", "name,mass\u00a0,warp_bending\ntwill\u00a0,0.3,2e-5\u00a0\n");
  CHECK(material_of(own.row("twill")).warp_bending == 2e-5);
  for (const std::string head : {"sep=,\nname,mass,warp_bending", "# cloths of spring", "calico,0.1,1e-6"}) {
    own.write("own.csv", head + "\ntwill,0.3,2e-5\n");
    CHECK_THROWS_WITH(material_of(own.row("twill")),
                      Contains("own.csv: the first line names no column of a fabric, such as mass"));
  }
  own.write("own.csv",
            "name,mass,warp_bending\ntwill,0.3,2e-5\ncalico,0.1,1e-6\ntwill,0.2,1e-5\n2,0.1,1e-6\n");
  CHECK(material_of(own.row("3")).warp_bending == 1e-5);
  CHECK(material_of(own.row("calico")).warp_bending == 1e-6);
}

TEST_CASE("drape fabric prints what a laboratory measures, and lists the table") {
  const Scratch folder;
  CHECK_THAT(shown_by("fabric", folder.path), Contains("11oz-black-denim      Wang et al. 2011"));
  // c = (23.19e-6 / (0.187 · 9.81))^⅓, in mm. What is a default says so.
  CHECK_THAT(shown_by("fabric gray-interlock", folder.path),
             Contains("187 g/m²") && Contains("bending length c             23.3") &&
                 Contains("thickness             0.318 mm (default, not measured)\n") &&
                 Contains("tensile stiffness           16.59      34.48") && Contains("  N/m\n") &&
                 !Contains("as of an isotropic cloth"));
  CHECK_THAT(shown_by("fabric cotton-broad", folder.path),
             Contains("hysteresis 2HB        1.216 mN, 0.12") &&
                 Contains("drape run configs/tests/cusick.yaml --set 'material.fabric=cotton-broad'") &&
                 Contains("thickness             0.497 mm\n") && Contains("N/m (default, not measured)\n") &&
                 Contains("weft and bias not measured: as of an isotropic cloth\n"));
  CHECK_THAT(shown_by("fabric wool-lycra", folder.path), Contains("N/m\n"));
  // A row's name is printed as YAML has it.
  const OwnFabrics own("name,mass,thickness,warp_bending\n\"twill, fine\",0.3,5e-4,2e-5\n");
  CHECK_THAT(shown_by("fabric 'twill, fine' --file own.csv", own.path),
             Contains("material: {fabric: {file: own.csv, row: \"twill, fine\"}}"));
  own.write("own.csv", "name,mass,thickness,warp_bending\nAnna's,0.3,5e-4,2e-5\n");
  CHECK_THAT(shown_by("fabric \"Anna's\" --file own.csv", own.path), Contains("row: \"Anna'\\''s\"}'\n"));
}
