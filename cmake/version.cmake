# FIIMAP_VERSION as package.xml says, the only place where it is written, and the function
# fiimap_set_version(LIBRARY...), which gives it to shared libraries. Programs ask for the first two
# numbers of it: every minor version may change what they were compiled for.
set(package_xml ${CMAKE_CURRENT_LIST_DIR}/../package.xml)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${package_xml})
file(STRINGS ${package_xml} version_line REGEX "<version>")
if(NOT version_line MATCHES "<version>(([0-9]+\\.[0-9]+)\\.[0-9]+)</version>")
  message(FATAL_ERROR "package.xml needs <version>X.Y.Z</version>, not '${version_line}'")
endif()
set(FIIMAP_VERSION ${CMAKE_MATCH_1})
set(FIIMAP_SOVERSION ${CMAKE_MATCH_2})

function(fiimap_set_version)
  set_target_properties(${ARGN} PROPERTIES
    VERSION ${FIIMAP_VERSION} SOVERSION ${FIIMAP_SOVERSION})
endfunction()
