# How everything that is built here is watched while it runs; off by default.
#   -DFIIMAP_SANITIZE=address,undefined   memory errors and undefined behaviour
#   -DFIIMAP_SANITIZE=thread              data races
#   -DFIIMAP_COVERAGE=ON                  which lines run
#   -DFIIMAP_FUZZ=ON                      the targets of test/fuzz; needs clang
set(FIIMAP_SANITIZE "" CACHE STRING "Sanitizers: address,undefined or thread; empty: none")
option(FIIMAP_COVERAGE "Count which lines run" OFF)
option(FIIMAP_FUZZ "Build libFuzzer's targets" OFF)

if(FIIMAP_SANITIZE)
  # The first finding ends the program. Assertions count as findings, those of the library too.
  add_compile_options(-fsanitize=${FIIMAP_SANITIZE} -fno-sanitize-recover=all
    -fno-omit-frame-pointer -O1 -g1 -UNDEBUG -D_GLIBCXX_ASSERTIONS)
  add_link_options(-fsanitize=${FIIMAP_SANITIZE})
endif()
if(FIIMAP_COVERAGE)
  add_compile_options(--coverage -O1)
  add_link_options(--coverage)
endif()
if(FIIMAP_FUZZ)
  if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
    message(FATAL_ERROR "FIIMAP_FUZZ needs -DCMAKE_CXX_COMPILER=clang++, not ${CMAKE_CXX_COMPILER}")
  endif()
  add_compile_options(-fsanitize=fuzzer-no-link)
endif()
