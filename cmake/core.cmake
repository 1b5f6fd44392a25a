# The map itself: the shared library fiimap_core from src/core, with Eigen and the standard library
# only. Shared, so that all nodelets of a process see the same MapRegistry.
# The package includes it, and test/arm, which needs no ROS.

include(${CMAKE_CURRENT_LIST_DIR}/version.cmake)

#catkin_lint: ignore_once duplicate_find
find_package(Eigen3 REQUIRED)
find_package(hwy QUIET)  # vector instructions; without it, plain C++ does
find_package(Threads REQUIRED)

set(core_root ${CMAKE_CURRENT_LIST_DIR}/..)
get_filename_component(core_root ${core_root} ABSOLUTE)
file(GLOB core_sources CONFIGURE_DEPENDS
  ${core_root}/src/core/*.cpp ${core_root}/src/core/kernels/*.cpp)
set(unused_kernels vector_kernels)
if(TARGET hwy::hwy)
  set(unused_kernels no_vector_kernels)
endif()
list(REMOVE_ITEM core_sources ${core_root}/src/core/kernels/${unused_kernels}.cpp)
add_library(fiimap_core SHARED ${core_sources})
fiimap_set_version(fiimap_core)
target_include_directories(fiimap_core PUBLIC ${core_root}/include)
target_include_directories(fiimap_core SYSTEM PUBLIC ${EIGEN3_INCLUDE_DIR})
target_link_libraries(fiimap_core PUBLIC Threads::Threads)
# No fused multiply-add where it is not asked for: every machine computes the same map.
target_compile_options(fiimap_core PRIVATE -ffp-contract=off)
if(TARGET hwy::hwy)
  target_link_libraries(fiimap_core PRIVATE hwy::hwy)
  # vector_kernels.cpp includes itself.
  target_include_directories(fiimap_core PRIVATE ${core_root}/src/core/kernels)
  set_source_files_properties(${core_root}/src/core/kernels/vector_kernels.cpp
    PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endif()
