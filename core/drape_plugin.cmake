# Builds a plugin library that drape finds by its folder (DRAPE_PLUGIN_PATH, or lib/drape beside bin).
#
#   drape_add_plugin(<name> SOURCES <file>...)
function(drape_add_plugin name)
  cmake_parse_arguments(PARSE_ARGV 1 plugin "" "" SOURCES)
  add_library(${name} MODULE ${plugin_SOURCES})
  # A plugin exports its one C function, so that two plugins may use one name for different things.
  set_target_properties(${name} PROPERTIES LINKER_LANGUAGE CXX CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
  target_link_libraries(${name} PRIVATE drape::engine)
  # Kernels at -O0 take many times as long: where the project chooses no build type, a plugin is compiled as in a Release.
  target_compile_options(${name} PRIVATE "$<$<CONFIG:>:-O3;-DNDEBUG>")
  # A missing symbol shows here, not when loading; a sanitizer's own are in the program alone.
  if(NOT "${CMAKE_CXX_FLAGS} ${CMAKE_CXX_FLAGS_DEBUG}" MATCHES "-fsanitize")
    target_link_options(${name} PRIVATE -Wl,--no-undefined)
  endif()
endfunction()
