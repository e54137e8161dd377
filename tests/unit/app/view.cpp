// What the viewer is given: blocks, colours' values, and the report's share of it.

#include <catch2/catch.hpp>
#include <cmath>
#include <cstring>
#include <limits>

#include "core/app/report/report.h"
#include "core/app/view/surface_fields.h"
#include "core/app/view/view_document.h"
#include "tests/support/metric_check.h"

using namespace drape;

namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();
const ViewDocument::Obstacles no_obstacles;  // documents refer to theirs

template <class T>
T number_at(const std::string& bytes, std::size_t place) {
  T value;
  std::memcpy(&value, bytes.data() + place, sizeof value);
  return value;
}

/// As viewer/blocks.js reads them.
Positions decoded(const std::string& bytes, Eigen::Index n) {
  Positions x(n, 3);
  for (int k = 0; k < 3; ++k) {
    const double lower = number_at<float>(bytes, 4 * k), size = number_at<float>(bytes, 12 + 4 * k);
    unsigned q = 0;
    for (Eigen::Index i = 0; i < n; ++i) {
      q = (q + number_at<std::uint16_t>(bytes, 24 + 2 * (k * n + i))) & 65535u;
      x(i, k) = lower + size * q / 65535;
    }
  }
  return x;
}

}  // namespace

TEST_CASE("positions come back within the rounding that is stated") {
  Positions x = square(7).rest.vertices * 3.7;
  x.col(2) = (5 * x.col(0)).array().sin() * x.col(1).array();
  const Eigen::RowVector3d size = x.colwise().maxCoeff() - x.colwise().minCoeff();
  for (const double far : {1.0, 1e5}) {
    INFO(far);
    x.rowwise() += far * Eigen::RowVector3d(10, -4, 0.3);
    const std::string bytes = encode_positions(x);
    REQUIRE(bytes.size() == 24 + 6 * 64);
    const Positions rounded = decoded(bytes, 64).cast<float>().cast<double>();
    const double error = (rounded - x).cwiseAbs().maxCoeff(), largest = x.cwiseAbs().maxCoeff();
    CHECK(error > 0);
    CHECK(error <= size.maxCoeff() / 65535 / 2 + std::ldexp(largest, -23));
  }
  x(3, 1) = none;
  CHECK(decoded(encode_positions(x), 64).allFinite());
  CHECK(decoded(encode_positions(Positions::Zero(2, 3)), 2).isZero(0));
}

TEST_CASE("triangles are differences, and pack well; scalars include their range's ends, 255 is missing") {
  const Level level = square(40);
  const std::string triangles = encode_triangles(level.rest.triangles);
  const Eigen::Index m = level.triangle_count();
  REQUIRE(triangles.size() == static_cast<std::size_t>(12 * m));
  for (int k = 0; k < 3; ++k) {
    int v = 0;
    for (Eigen::Index t = 0; t < m; ++t) {
      v += number_at<std::int32_t>(triangles, 4 * (k * m + t));
      REQUIRE(v == level.rest.triangles(t, k));
    }
  }
  CHECK(deflated(triangles).size() < triangles.size() / 10);

  const std::string scalars = encode_scalars(Eigen::Vector4d(-9, 1, none, 99), 0, 2);
  REQUIRE(scalars.size() == 12);
  CHECK(number_at<float>(scalars, 0) == 0);
  CHECK(number_at<float>(scalars, 4) == 2);
  CHECK(scalars.substr(8) == std::string("\0\x7f\xff\xfe", 4));
}

TEST_CASE("the gap is the distance to an obstacle, or to the cloth folded over itself") {
  const Level level = square(20);
  const TriangleMesh table{level.rest.vertices * 3, level.rest.triangles};
  Positions x = level.rest.vertices;
  x.col(2).setConstant(0.004);
  CHECK(contact_gap(level, x, {table}, 0.01).isApproxToConstant(0.004, 1e-12));
  CHECK(contact_gap(level, x, {table}, 0.003).array().isNaN().all());
  CHECK(contact_gap(level, x, {}, 0.01).array().isNaN().all());  // flat, it is not near itself

  // Folded in the middle, the halves 8 mm apart.
  for (Eigen::Index i = 0; i < x.rows(); ++i)
    if (x(i, 0) > 0.5) x.row(i) << 1 - x(i, 0), x(i, 1), 0.012;
  const Eigen::VectorXd gap = contact_gap(level, x, {}, 0.01);
  CHECK(gap[0] == Approx(0.008));
  CHECK(gap[20] == Approx(0.008));
  CHECK(std::isnan(gap[10]));  // at the crease
}

TEST_CASE("nearly all magnitudes lie in a field's range, and what is not finite counts for nothing") {
  Eigen::VectorXd v(5);
  v << 0, 1, 5, -1, none;
  const Eigen::VectorXd ramp = Eigen::VectorXd::LinSpaced(101, -100, 0);
  const auto range = [](const char* map, const std::vector<const Eigen::VectorXd*>& values) {
    return field_range({"f", "f", "1", map, ""}, values, 0.25);
  };
  CHECK(range("diverging", {&ramp}) == std::pair(-98.0, 98.0));
  CHECK(range("force", {&ramp}) == std::pair(0.0, 98.0));
  CHECK(range("sequential", {&ramp, &v}) == std::pair(1.0, 100.0));
  CHECK(range("near", {&ramp}) == std::pair(0.0, 0.25));
  CHECK(range("force", {}) == std::pair(0.0, 0.0));
}

TEST_CASE("contact forces are coloured from zero, and not where there are none") {
  const std::vector<Level> levels = {square(1)};
  std::map<std::string, std::string> blocks;
  ViewDocument view(levels, no_obstacles, true,
                    [&](const std::string& name, const std::string& bytes) { blocks[name] = bytes; });
  const SurfaceFields fields = view.fields(0, levels[0].rest.vertices, Eigen::Vector4d(0, 2, 4, 4));
  view.set_ranges({&fields});
  const Json state = view.state("s", levels[0].rest.vertices, fields),
             document = view.document("a title", {}), last = document["fields"].back();
  CHECK((last["name"] == "contact_pressure" && last["low"] == 0.0 && last["high"] == 4.0));
  CHECK(blocks.at(state["fields"]["contact_pressure"]).substr(8) == "\xff\x7f\xfe\xfe");
}

TEST_CASE("a field's colours range over the states that are shown") {
  const std::vector<Level> levels = {square(1)};
  ViewDocument view(levels, no_obstacles, false, [](const std::string&, const std::string&) {});
  const auto stretched = [](double largest) {
    return SurfaceFields{{"stretch", Eigen::VectorXd(Eigen::VectorXd::LinSpaced(4, 1, largest))}};
  };
  const SurfaceFields little = stretched(1.25), much = stretched(1.5);
  CHECK(view.set_ranges({&little}));
  CHECK(view.set_ranges({&much}));
  CHECK_FALSE(view.set_ranges({&little, &much}));
  CHECK_FALSE(view.set_ranges({&little}));
  CHECK(view.document("a title", {})["fields"][0]["high"] == 1.25);
  CHECK_FALSE(view.set_ranges({}));
  CHECK(view.document("a title", {})["fields"][0]["high"] == 1.25);
}

TEST_CASE("a page of one state holds its blocks and names no other file") {
  const Level level = square(3);
  const std::string page = viewer_page("a <state>", level, 1.1 * level.rest.vertices, {square(1).rest});
  for (const char* part : {"<title>a &lt;state>", "\"kind\":\"states\"", "id=\"viewer-state\"",
                           "id=\"viewer-l0\"", "id=\"viewer-obstacle0\""})
    CHECK(page.find(part) != std::string::npos);
  CHECK(page.find("<script src") == std::string::npos);
}
