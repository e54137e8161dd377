# Writes OUTPUT, the definitions of core/kernel/version.h, if they have changed. Documents, tests, stored results, what makes pages of
# them, and run_studies are not part of what is built or measured: their changes leave the commit clean (as in
# benchmarks/run_studies).
set(git git -C ${SOURCE_DIR} -c safe.directory=*)
execute_process(COMMAND ${git} describe --always --tags OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
execute_process(COMMAND ${git} diff --quiet HEAD -- . ":(exclude)*.md" ":(exclude)docs" ":(exclude)tests"
                ":(exclude)plugins/*/test_*" ":(exclude)benchmarks/results" ":(exclude)benchmarks/fill_figures"
                ":(exclude)benchmarks/figures.py" ":(exclude)benchmarks/plots.py" ":(exclude)benchmarks/run_studies"
                RESULT_VARIABLE changed ERROR_QUIET)
if(NOT COMMIT)
  set(COMMIT unknown)
elseif(changed)
  string(APPEND COMMIT -dirty)
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.cpp.in ${OUTPUT} @ONLY)
