#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "core/experiment/experiment.h"
#include "core/experiment/reference.h"
#include "core/mesh/check.h"
#include "core/mesh/generate.h"
#include "core/mesh/io.h"

namespace drape {

namespace {

TriangleMesh make_grid(const ClothParameters& c, const Eigen::Vector2d& size) {
  const double density = std::sqrt(c.vertices / (size.x() * size.y()));
  const int columns =
      c.columns > 0 ? c.columns : std::max(2, static_cast<int>(std::lround(density * size.x())));
  const int rows = c.rows > 0 ? c.rows : std::max(2, static_cast<int>(std::lround(density * size.y())));
  return grid(size, columns, rows,
              c.triangulation == "one_way" ? Diagonals::one_way : Diagonals::criss_cross);
}

TriangleMesh make_cloth(const Experiment& e) {
  const ClothParameters& c = e.parameters.cloth;
  if (c.shape == "file") {
    if (c.file.empty()) throw std::runtime_error("\"shape: file\" needs \"file\", the mesh to read");
    return read_mesh(c.file);
  }
  if (c.shape == "disc") return disc(c.radius, c.vertices);
  if (c.shape == "polygon") {
    std::vector<std::vector<Eigen::Vector2d>> loops;
    for (std::size_t k = 0; k < c.loops.size(); ++k) {
      const auto& p = c.loops[k].points;
      if (p.size() % 2 != 0)
        throw std::runtime_error("loop " + std::to_string(k) + " has an odd number of coordinates");
      auto& loop = loops.emplace_back();
      for (std::size_t i = 0; i + 1 < p.size(); i += 2) loop.emplace_back(p[i], p[i + 1]);
    }
    if (loops.empty()) throw std::runtime_error("\"shape: polygon\" needs \"loops\", its outline and holes");
    return delaunay_polygon(loops, c.vertices, c.seed);
  }
  const Eigen::Vector2d size = c.shape == "square" ? Eigen::Vector2d(c.side, c.side) : c.size;
  if (c.triangulation == "random") return random_triangulation(size, c.vertices, c.seed);
  return make_grid(c, size);
}

/// Smooth noise with values about ±1 that depends on the place and the seed alone: some plane waves.
class Noise {
 public:
  Noise(double wavelength, int seed) {
    std::mt19937_64 random(static_cast<std::uint64_t>(seed));
    // Not a std:: distribution, whose values differ between libraries.
    auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
    for (Wave& w : waves_) {
      const double angle = 2 * M_PI * uniform(), k = 2 * M_PI / (wavelength * (0.75 + 0.5 * uniform()));
      w = {k * std::cos(angle), k * std::sin(angle), 2 * M_PI * uniform()};
    }
  }
  double at(double x, double y) const {
    double sum = 0;
    for (const Wave& w : waves_) sum += std::sin(w.kx * x + w.ky * y + w.phase);
    return sum / std::sqrt(8.0);
  }

 private:
  struct Wave {
    double kx, ky, phase;
  } waves_[8];
};

Positions make_start(const Positions& rest, const std::vector<char>& fixed, const StartParameters& s) {
  const double degree = M_PI / 180;
  const Eigen::Matrix3d turn = (Eigen::AngleAxisd(s.rotate.z() * degree, Eigen::Vector3d::UnitZ()) *
                                Eigen::AngleAxisd(s.rotate.y() * degree, Eigen::Vector3d::UnitY()) *
                                Eigen::AngleAxisd(s.rotate.x() * degree, Eigen::Vector3d::UnitX()))
                                   .toRotationMatrix();
  const Noise noise(s.perturbation_wavelength, s.seed);
  Positions x(rest.rows(), 3);
  for (Eigen::Index i = 0; i < rest.rows(); ++i) {
    Eigen::Vector3d p = rest.row(i).transpose().cwiseProduct(s.scale);
    if (s.perturbation > 0 && !fixed[i]) p.z() += s.perturbation * noise.at(rest(i, 0), rest(i, 1));
    x.row(i) = (turn * p + s.translate).transpose();
  }
  return x;
}

/// The vertices of one pin.
std::vector<int> pinned_by(const PinParameters& pin, const Level& level) {
  const Positions& X = level.rest.vertices;
  std::vector<int> held;
  auto hold = [&](Eigen::Index i) { held.push_back(static_cast<int>(i)); };
  if (pin.region == "nearest") {
    Eigen::Index nearest = 0;
    (X.rowwise() - pin.point.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
    hold(nearest);
  } else if (pin.region == "vertices") {
    // Children of coarse vertices keep their index on every level.
    for (int v : pin.vertices)
      if (v >= 0 && v < X.rows()) hold(v);
  } else {
    for (Eigen::Index i = 0; i < X.rows(); ++i) {
      const Eigen::Vector3d p = X.row(i);
      const bool in_ball = (p - pin.point).norm() <= pin.radius * (1 + 1e-12);
      const bool in_box =
          (p.array() >= pin.lower.array() - 1e-12).all() && (p.array() <= pin.upper.array() + 1e-12).all();
      if (pin.region == "border" ? level.topology.on_border[i] : pin.region == "ball" ? in_ball : in_box)
        hold(i);
    }
  }
  return held;
}

}  // namespace

void refuse_touching_start(const Experiment& e, const LevelModel& model, const Positions& start,
                           ConfigErrors& errors) {
  constexpr std::size_t most_said = 3;
  for (const auto& contact : model.contacts()) {
    const std::vector<Touch> touches = contact->intersections(start);
    for (std::size_t k = 0; k < std::min(touches.size(), most_said); ++k)
      errors.push_back({e.place_of("start"), "the start of level " + std::to_string(model.level().index) +
                                                 " touches: " + to_string(touches[k])});
    if (touches.size() > most_said)
      errors.push_back(
          {e.place_of("start"), "… and " + std::to_string(touches.size() - most_said) +
                                    " more pairs; move the start or the obstacle so that they are apart"});
  }
}

Location Experiment::place_of(const std::string& key) const {
  const ConfigNode* node = source.find(key);
  return node ? node->where : source.where;
}

Problem Scene::problem() const {
  Problem p{hierarchy, {}, starts};
  for (const auto& model : models) p.models.push_back(model.get());
  return p;
}

std::unique_ptr<Scene> build_scene(const Experiment& e, ConfigErrors& errors, TouchingStart touching) {
  const ExperimentParameters& p = e.parameters;
  TriangleMesh cloth;
  try {
    cloth = make_cloth(e);
  } catch (const std::exception& error) {
    errors.push_back({e.place_of("cloth"), error.what()});
    return nullptr;
  }
  const std::string file = p.cloth.shape == "file" ? p.cloth.file + ": " : "";
  for (const std::string& fault : check_mesh(cloth)) errors.push_back({e.place_of("cloth"), file + fault});
  if (!errors.empty()) return nullptr;

  auto scene = std::make_unique<Scene>();
  try {
    scene->hierarchy = Hierarchy::of(std::move(cloth), *e.refiner, p.levels);
  } catch (const std::exception& error) {
    errors.push_back({e.place_of("cloth"), error.what()});
    return nullptr;
  }
  const ConfigNode* pins = e.source.find("pins");
  for (const Level& level : scene->hierarchy.levels) {
    std::vector<char> fixed(level.vertex_count(), 0);
    std::vector<std::vector<int>> held;
    for (std::size_t k = 0; k < p.pins.size(); ++k) {
      held.push_back(pinned_by(p.pins[k], level));
      for (int v : held.back()) fixed[v] = 1;
      if (level.index > 0) continue;
      const std::string pin = "pin " + std::to_string(k) + " (" + p.pins[k].region + ")";
      const bool by_index = p.pins[k].region == "vertices";
      if (by_index ? p.pins[k].vertices.empty() : held.back().empty())
        errors.push_back(
            {pins->items[k].where, pin + " holds no vertex of the coarsest level; " +
                                       (by_index ? "list some under \"vertices\"" : "widen its region")});
      for (int v : p.pins[k].vertices)
        if (by_index && (v < 0 || v >= level.vertex_count()))
          errors.push_back({pins->items[k].where, pin + " names vertex " + std::to_string(v) +
                                                      ", but those of the coarsest level go from 0 to " +
                                                      std::to_string(level.vertex_count() - 1)});
    }
    if (!errors.empty()) return nullptr;
    Positions start = make_start(level.rest.vertices, fixed, p.start);
    for (std::size_t k = 0; k < p.pins.size(); ++k)
      if (p.pins[k].move)
        for (int v : held[k]) start.row(v) = level.rest.vertices.row(v) + p.pins[k].move->transpose();
    scene->starts.push_back(std::move(start));
    try {
      scene->models.push_back(
          std::make_unique<LevelModel>(level, p.material, e.energies, std::move(fixed), e.contacts));
    } catch (const std::exception& error) {
      errors.push_back({e.place_of("energies"), error.what()});
      return nullptr;
    }
    if (touching == TouchingStart::refused)
      refuse_touching_start(e, *scene->models.back(), scene->starts.back(), errors);
    if (!errors.empty()) return nullptr;
  }
  scene->reference = read_reference(e, scene->hierarchy, errors);
  return errors.empty() ? std::move(scene) : nullptr;
}

}  // namespace drape
