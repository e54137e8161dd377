#include "core/app/run/steered_solve.h"

#include <stdexcept>

#include "core/app/experiment/experiment_path.h"
#include "core/app/experiment/method_choice.h"
#include "core/app/run/checkpoint_manager.h"

namespace drape {

std::unique_ptr<SteeredSolve> SteeredSolve::begin(ConfigNode source, const std::string& method,
                                                  const Registry& registry, ConfigErrors& errors,
                                                  MethodState from) {
  auto experiment = read_experiment(std::move(source), registry, errors);
  if (!experiment) return nullptr;
  using Names = std::vector<std::string>;
  const Names chosen = chosen_methods(*experiment, method.empty() ? Names{} : Names{method});
  if (chosen.size() != 1) throw std::runtime_error("name one method to iterate, not all");
  std::unique_ptr<SteeredSolve> s(new SteeredSolve);
  s->method_ = chosen.front();
  s->experiment_ = std::make_shared<const Experiment>(std::move(*experiment));
  s->scene_ = build_scene(*s->experiment_, errors);
  if (!s->scene_) return nullptr;
  s->solve_ =
      std::make_unique<SteppedSolve>(s->experiment_->solver_of(s->method_), *s->scene_, std::move(from));
  return s;
}

bool SteeredSolve::set(const std::string& key, const std::string& value, ConfigErrors& errors) {
  const bool iterated = solve_->x().rows() > 0;
  if (!iterated && level_ < 0)
    throw std::runtime_error("nothing is iterated yet; set " + key + " in the experiment");
  ConfigNode source = experiment_->source;
  if (!set_parameter(source, key, value, "--set " + key, errors)) return false;
  auto changed = read_experiment(std::move(source), *experiment_->registry, errors);
  if (!changed) return false;
  MethodState from;
  from.level = iterated ? solve_->row().level : level_;
  const Positions& x = iterated ? solve_->x() : scene_->starts[from.level];
  refuse_other_cloth(*experiment_, *changed, from.level, errors);
  if (!errors.empty()) return false;
  auto experiment = std::make_shared<const Experiment>(std::move(*changed));
  std::shared_ptr<Scene> scene = build_scene(*experiment, errors, IntersectingStart::allowed);
  if (scene) warm_start_scene(*experiment, *scene, from.level, x, errors);
  if (!errors.empty()) return false;
  const int level = from.level;
  auto solve = std::make_unique<SteppedSolve>(experiment->solver_of(method_), *scene, std::move(from));
  level_ = level;
  solve_ = std::move(solve);
  experiment_ = std::move(experiment);
  scene_ = std::move(scene);
  return true;
}

}  // namespace drape
