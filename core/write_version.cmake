# Writes OUTPUT, the definitions of core/kernel/version.h, if they have changed. Documents and stored results are no part of
# what is built: changes of theirs leave the commit clean.
set(git git -c safe.directory=*)
execute_process(COMMAND ${git} describe --always --tags
                WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE COMMIT OUTPUT_STRIP_TRAILING_WHITESPACE
                ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
  set(COMMIT unknown)
else()
  execute_process(COMMAND ${git} diff --quiet HEAD -- . ":(exclude)*.md" ":(exclude)docs" ":(exclude)benchmarks/results"
                  WORKING_DIRECTORY ${SOURCE_DIR} RESULT_VARIABLE changed)
  if(changed)
    string(APPEND COMMIT -dirty)
  endif()
endif()
configure_file(${CMAKE_CURRENT_LIST_DIR}/version.cpp.in ${OUTPUT} @ONLY)
