# shellcheck shell=bash
(cd "$work" && build/drape_a_square | tee said)
[ "$(grep -c '^level [012]: converged after' "$work/said")" = 3 ] || fail "the square is not at rest on three levels"
# The free side hangs a metre below the corners, and the cloth sags between them.
awk '/^level 2/ { z = $(NF - 1); exit !(z < -1.1 && z > -1.3) }' "$work/said" || fail "the square does not hang"
[ "$(grep -c '^v ' "$work/level_2.obj")" = 6561 ] || fail "level_2.obj is not the finest level"
