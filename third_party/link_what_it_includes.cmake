# For sources that call CGAL. Exact predicates rest on directed rounding: no folding of constants, no fused multiply-add.
set(DRAPE_EXACT_OPTIONS -frounding-math -ftrapping-math -ffp-contract=off)

# Links a target with those of the optional libraries that files in its folders include, so that no
# plugin needs a line of CMake for them.
#
#   drape_link_what_it_includes(<target> <.cpp and .h files>...)
function(drape_link_what_it_includes target)
  foreach(file IN LISTS ARGN)
    file(STRINGS ${file} includes REGEX "^#include <(CGAL|fcl|ccd)/")
    if(includes MATCHES "<CGAL/")
      target_link_libraries(${target} PRIVATE drape_cgal)
      set_source_files_properties(${file} PROPERTIES SKIP_PRECOMPILE_HEADERS ON
        COMPILE_OPTIONS "${DRAPE_EXACT_OPTIONS}")
    endif()
    foreach(library fcl ccd)
      if(includes MATCHES "<${library}/")
        target_link_libraries(${target} PRIVATE ${library})
      endif()
    endforeach()
  endforeach()
endfunction()
