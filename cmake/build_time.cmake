# Build time: headers of other projects that most sources include, precompiled. Each source includes what it needs all the
# same, and -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON builds without them. (Those of ROS are left out: what is gained in reading
# them is lost in loading them.)
if(CMAKE_CXX_COMPILER_LAUNCHER MATCHES "ccache" AND NOT DEFINED CMAKE_DISABLE_PRECOMPILE_HEADERS)
  set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)  # ccache does not store what is compiled with them
endif()
if(NOT CMAKE_DISABLE_PRECOMPILE_HEADERS)
  add_compile_options(-fPIC)  # programs too, as libraries: a precompiled header goes with one kind of code
endif()

# arfm_headers(NAME [LIBRARIES library ...] HEADERS header ...), then arfm_use_headers(TARGET NAME) for each user.
set(empty_source ${CMAKE_CURRENT_BINARY_DIR}/empty.cpp)
if(NOT EXISTS ${empty_source})
  file(WRITE ${empty_source} "")
endif()
function(arfm_headers name)
  cmake_parse_arguments(PRECOMPILED "" "" "LIBRARIES;HEADERS" ${ARGN})
  add_library(arfm_vo_${name} OBJECT EXCLUDE_FROM_ALL ${empty_source})
  target_link_libraries(arfm_vo_${name} PRIVATE ${PRECOMPILED_LIBRARIES})
  target_precompile_headers(arfm_vo_${name} PRIVATE ${PRECOMPILED_HEADERS})
endfunction()
function(arfm_use_headers target name)
  target_precompile_headers(${target} REUSE_FROM arfm_vo_${name})
endfunction()

set(libraries opencv_core opencv_imgproc Eigen3::Eigen)
set(headers <algorithm> <array> <cmath> <filesystem> <functional> <limits> <memory> <optional> <sstream> <string> <vector>
  <Eigen/Cholesky> <Eigen/Geometry> <Eigen/LU> <opencv2/core.hpp> <opencv2/imgproc.hpp>)
arfm_headers(headers LIBRARIES ${libraries} HEADERS ${headers})
if(CATKIN_ENABLE_TESTING)
  arfm_headers(test_headers LIBRARIES ${libraries} ${GTEST_LIBRARIES} gmock HEADERS ${headers} <gmock/gmock.h> <gtest/gtest.h>)
endif()

# arfm_compile_quickly(TARGET): for code whose speed does not count, in two thirds of the time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_GREATER_EQUAL 13
    AND CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # Which -O3 implies there (the second from GCC 14 on): a precompiled header is used by the same options only.
  set(alike ";-munroll-only-small-loops;-mvzeroupper")
endif()
function(arfm_compile_quickly target)
  target_compile_options(${target} PRIVATE "$<$<CONFIG:Release>:-O1${alike}>")
endfunction()
# arfm_compile_together(TARGET): sources in groups of eight, each read as one: headers are read once for all. (Those with compile
# options of their own stay alone; a group of ros takes 1.3 GB.) -DARFM_VO_UNITY=OFF compiles each alone.
option(ARFM_VO_UNITY "compile sources in groups" ON)
function(arfm_compile_together target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD ${ARFM_VO_UNITY} UNITY_BUILD_BATCH_SIZE 8)
endfunction()

# A library calls its own copy of a function template, never one of a program or test that was compiled so.
string(APPEND CMAKE_SHARED_LINKER_FLAGS " -Wl,-Bsymbolic-functions")
