# shellcheck shell=bash
python3 - "$work/results/results.json" <<'PYTHON' || fail "results.json is not as the page says"
import json, sys
methods = json.load(open(sys.argv[1]))["methods"]
pcs, direct = methods["pcs"]["levels"], methods["finest_only"]["levels"]
assert [level["level"] for level in pcs] == [0, 1], pcs
assert [level["level"] for level in direct] == [1], direct
for level in pcs + direct:
    assert level["status"] == "converged" and level["intersections"] == 0, level
    assert 0 < level["smallest_gap"] < 2e-3, level
    # As low as it lies: the metric and the contact model agree.
    assert abs(level["height"] - level["smallest_gap"]) < 1e-9, level
energies = [pcs[-1]["energy"], direct[-1]["energy"]]
assert abs(energies[0] - energies[1]) < 1e-3 * abs(energies[0]), energies
PYTHON
# The level above the coarsest begins on the smooth surface: its rest shape still has the square's corners.
vertices "$work/results/rest/l1.ply" | sort -g | tail -n 1 | grep -q "0.4 " || fail "the rest shape has no corner at 0.4"
