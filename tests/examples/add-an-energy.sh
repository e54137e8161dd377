# shellcheck shell=bash
grep -q "1/s²" "$work/described" || fail "drape describe does not show the unit of stiffness"
# The vertex farthest from the held side rests at z = -g/k.
vertices "$work/results/levels/pcs_l1.ply" | sort -g | tail -n 1 |
  awk '{ print "z at the free side: " $3 " m"; e = $3 + 9.81 / 400; exit !(e < 1e-5 && e > -1e-5) }' ||
  fail "the free side is not at -g/k"

# The page's first command, with a cache of its own.
unset DRAPE_PLUGIN_PATH
export XDG_CACHE_HOME=$work/cache
(cd "$work/source" && "$drape" run woven.yaml --plugin orthotropic.cpp --out "$work/woven")
# ρ d g L² / (2 warp (1 - poisson²)), to what the held side changes.
vertices "$work/woven/levels/pcs_l1.ply" | sort -g | tail -n 1 |
  awk '{ print "x at the free side: " $1 " m"; e = ($1 - 0.5) / 0.00096 - 1; exit !(e < 0.05 && e > -0.05) }' ||
  fail "the free side is not where the stiffness of warp has it"
