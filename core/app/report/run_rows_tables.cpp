#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/app/report/chart_data.h"
#include "core/app/report/run_rows.h"
#include "core/app/view/html.h"
#include "core/kernel/plugin/config_node.h"

namespace drape {

namespace {

using html::Cell;
using html::escape;
using html::number_text;
using html::words;
using Row = std::vector<Cell>;
using Json = nlohmann::ordered_json;

constexpr int curve_points = 40;
constexpr double noticeable = 0.05;  // smaller relative differences of medians are not mentioned

/// Rounded for display; in full precision for exported tables.
std::string shown(const std::optional<Spread>& spread) {
  if (!spread) return number_text({});
  const std::string low = number_text(spread->low), high = number_text(spread->high);
  std::string full;
  for (const double value : {spread->median, spread->low, spread->high})
    full += (full.empty() ? "" : " ") + ConfigNode::of(value).scalar;
  return "<span data-spread=\"" + full + "\">" + number_text(spread->median) + "</span>" +
         (low == high ? "" : "<span class=\"range\">" + low + " … " + high + "</span>");
}

using Quantities = std::vector<RowQuantity>;

std::optional<Spread> spread_of(const RunRow& row, const Quantities& quantities, const std::string& name) {
  for (const RowQuantity& quantity : quantities)
    if (quantity.name == name) return spread_of(row, quantity);
  return std::nullopt;
}

/// The measures by which summaries rank methods.
std::vector<ErrorMeasure> ranking(const RunCollection& collection) {
  std::vector<ErrorMeasure> measures = collection.error_measures();
  std::erase_if(measures, [](const ErrorMeasure& m) { return m.use != ErrorUse::ranking; });
  return measures;
}

/// What summaries compare: a quantity, and words for less and for more of it.
struct Criterion {
  std::string quantity;
  const char *less, *more;
};

std::vector<Criterion> criteria_of(const RunCollection& collection) {
  std::vector<Criterion> criteria = {{"seconds", "faster", "slower"}};
  for (const ErrorMeasure& m : ranking(collection)) {
    criteria.push_back({preview_name(m), "better preview", "worse preview"});
    criteria.push_back({error_name(m), "nearer to the reference", "further from the reference"});
  }
  return criteria;
}

/// "1.4× faster" and the like; empty if both are about equal or one is unknown.
std::string ratio_words(const RunRow& row, const RunRow& base, const Quantities& quantities,
                        const Criterion& criterion) {
  const auto mine = spread_of(row, quantities, criterion.quantity),
             other = spread_of(base, quantities, criterion.quantity);
  if (!mine || !other || !(mine->median > 0) || !(other->median > 0)) return "";
  const double ratio = mine->median / other->median;
  if (ratio < 1 - noticeable) return number_text(1 / ratio) + "× " + criterion.less;
  if (ratio > 1 + noticeable) return number_text(ratio) + "× " + criterion.more;
  return "";
}

std::string verdict(const RunRow& row, const RunRow& base, const Quantities& quantities,
                    const std::vector<Criterion>& criteria) {
  const int missed = static_cast<int>(row.repeats.size()) - row.converged;
  std::string text = missed > 0 ? std::to_string(missed) + " did not converge" : "";
  if (&row == &base) return text.empty() ? "what the others are compared with" : text;
  for (const Criterion& criterion : criteria)
    if (const std::string part = ratio_words(row, base, quantities, criterion); !part.empty())
      text += (text.empty() ? "" : "; ") + part;
  return text.empty() ? "about the same" : text;
}

/// The same method under the first variation that has it; with one variation, the last method.
const RunRow& base_of(const RunRow& row, const std::vector<RunRow>& rows) {
  if (rows.front().variation == rows.back().variation) return rows.back();
  return *std::find_if(rows.begin(), rows.end(), [&](const RunRow& r) { return r.method == row.method; });
}

std::string lowest(const std::vector<RunRow>& rows, bool several, const Quantities& all,
                   const std::string& name) {
  const RunRow* best = nullptr;
  std::optional<Spread> least;
  for (const RunRow& row : rows) {
    const auto spread = spread_of(row, all, name);
    if (spread && (!least || spread->median < least->median)) best = &row, least = spread;
  }
  return best ? "<b>" + escape(best->title(several)) + "</b> (" + number_text(least->median) + ")" : "";
}

/// Says which methods' final states were the reference, so that their errors are left out.
std::string own_references(const std::vector<RunRow>& rows, bool several) {
  std::string text;
  for (const RunRow& row : rows) {
    const auto own = std::count_if(row.repeats.begin(), row.repeats.end(), [](const Repeat& repeat) {
      return is_own_reference(*repeat.run->data, *repeat.method);
    });
    if (own == 0) continue;
    text += (text.empty() ? "" : ", ") + escape(row.title(several)) + " in " + std::to_string(own) + " of " +
            std::to_string(row.repeats.size());
  }
  if (text.empty()) return "";
  return " Final states that were the reference themselves are not compared with it: " + text + ".";
}

}  // namespace

std::string rows_table(const RunCollection& collection) {
  const std::vector<RunRow> rows = rows_of(collection);
  if (rows.empty()) return "<p class=\"absent\">No run has written results yet.</p>";
  const Quantities all = row_quantities(collection.error_measures());
  const std::vector<Criterion> criteria = criteria_of(collection);
  std::vector<const RowQuantity*> quantities;
  for (const RowQuantity& f : all)
    if (std::any_of(rows.begin(), rows.end(), [&](const RunRow& r) { return spread_of(r, f).has_value(); }))
      quantities.push_back(&f);
  Row head = {words("variation"), words("method"), words("verdict"), {"converged"}};
  for (const RowQuantity* f : quantities) head.push_back(html::head(f->title, f->name));
  std::vector<Row> body;
  for (const RunRow& row : rows) {
    Row cells;
    const auto same = [&](const RunRow& r) { return r.variation == row.variation; };
    if (&row == &*std::find_if(rows.begin(), rows.end(), same)) {
      cells.push_back(words(escape(row.variation)));
      cells.back().rows = static_cast<int>(std::count_if(rows.begin(), rows.end(), same));
    }
    cells.push_back(words(escape(row.method)));
    cells.push_back(
        words("<span class=\"verdict\">" + verdict(row, base_of(row, rows), all, criteria) + "</span>"));
    cells.push_back({std::to_string(row.converged) + " of " + std::to_string(row.repeats.size())});
    for (const RowQuantity* f : quantities) cells.push_back({shown(spread_of(row, *f))});
    body.push_back(cells);
  }
  return html::table({head}, body);
}

std::string failures_table(const RunCollection& collection) {
  std::vector<Row> body;
  for (const RunRecord& run : collection.runs) {
    if (run.status == "converged" || (run.status == "not_converged" && run.error.empty())) continue;
    body.push_back({words(escape(run.variation)),
                    {html::count(run.seed)},
                    words(escape(run.status.empty() ? "unknown" : run.status)),
                    words("<span class=\"message\">" + escape(run.error) + "</span>")});
  }
  return body.empty() ? ""
                      : html::table({{words("variation"), {"seed"}, words("status"), words("error")}}, body);
}

std::string collection_summary(const RunCollection& collection) {
  const std::vector<RunRow> rows = rows_of(collection);
  const auto with = [&](const std::string& status) {
    return std::count_if(collection.runs.begin(), collection.runs.end(),
                         [&](const RunRecord& r) { return r.status == status; });
  };
  const std::size_t variations = collection.variations().size();
  std::string text = collection.complete ? "" : "Not all runs are done; these are the figures so far. ";
  text += std::to_string(collection.runs.size()) + " runs of " + std::to_string(variations) +
          (variations == 1 ? " variation" : " variations") + ": " + std::to_string(with("converged")) +
          " converged";
  for (const char* status : {"not_converged", "failed", "cancelled", "running", "pending"})
    if (const auto n = with(status))
      text += ", " + std::to_string(n) +
              (std::string(status) == "not_converged" ? " finished without converging everywhere"
                                                      : " " + std::string(status));
  text += ".";
  const bool several = variations > 1;
  std::vector<std::pair<std::string, std::string>> titles = {
      {"seconds", "Fastest to its final state, in seconds: "}};
  for (const ErrorMeasure& m : ranking(collection)) {
    const std::string label = html::formula(m.label);
    titles.emplace_back(preview_name(m), "Best preview, by its own error (" + label + "): ");
    titles.emplace_back(error_name(m), "Nearest to the reference (" + label + "): ");
  }
  const Quantities quantities = row_quantities(collection.error_measures());
  for (const auto& [name, title] : titles)
    if (const std::string best = lowest(rows, several, quantities, name); rows.size() > 1 && !best.empty())
      text += " " + title + best + ".";
  return text + own_references(rows, several);
}

std::string rows_chart_data(const RunCollection& collection) {
  const std::vector<RunRow> rows = rows_of(collection);
  const bool several = collection.variations().size() > 1;
  const std::vector<ErrorMeasure> measures = collection.error_measures();
  const Quantities quantities = row_quantities(measures);
  Json methods = Json::array();
  for (const std::string& name : collection.methods())
    for (const RunRow& row : rows)
      if (row.method == name) {
        methods.push_back(method_json(name, row.repeats.front().method->solver));
        break;
      }
  Json data = {{"variations", collection.variations()},
               {"methods", methods},
               {"measures", measures_json(measures)},
               {"rows", Json::array()}};
  for (const RunRow& row : rows)
    data["rows"].push_back(
        {{"title", row.title(several)}, {"variation", row.variation}, {"method", row.method}});
  for (std::size_t w = 0; w < error_costs.size(); ++w)
    for (std::size_t t = 0; t < error_targets.size(); ++t)
      for (const ErrorMeasure& m : measures) {
        Json plot = {{"curves", Json::array()}, {"front", Json::array()}};
        std::vector<CostPoint> all;
        std::vector<std::size_t> row_of;
        for (std::size_t r = 0; r < rows.size(); ++r) {
          std::vector<std::vector<CostPoint>> repeats;
          for (const Repeat& repeat : rows[r].repeats)
            repeats.push_back(error_curve(*repeat.run->data, rows[r].method, w, t, m.name));
          Json curve = Json::array();
          for (const CurvePoint& p : median_curve(repeats, curve_points)) {
            curve.push_back({rounded(p.cost), rounded(p.error.median), rounded(p.error.low),
                             rounded(p.error.high), p.error.count});
            all.push_back({p.cost, p.error.median});
            row_of.push_back(r);
          }
          plot["curves"].push_back(curve);
        }
        for (const std::size_t k : pareto_front(all))
          plot["front"].push_back({rounded(all[k].cost), rounded(all[k].error), row_of[k]});
        data["errors"][error_costs[w]][error_targets[t]][m.name] = plot;
      }
  for (const char* name : {"seconds", "iterations", "flops"})
    for (const RunRow& row : rows) {
      const auto s = spread_of(row, quantities, name);
      data["costs"][name].push_back(s ? Json{rounded(s->median), rounded(s->low), rounded(s->high)} : Json());
    }
  return html::script_json(data);
}

}  // namespace drape
