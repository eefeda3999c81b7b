# arfm_prepare(TARGET [library ...]): the includes and libraries of a program of the tests, compiled quickly.
function(arfm_prepare target)
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR}/test ${PROJECT_SOURCE_DIR}/src)  # of src: kernels, stages
  target_link_libraries(${target} ${ARGN})
  target_compile_definitions(${target} PRIVATE ARFM_VO_SOURCE_DIR="${PROJECT_SOURCE_DIR}"
    ARFM_VO_PROGRAM_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}")
  arfm_compile_quickly(${target})
endfunction()

# arfm_unit_test(NAME SOURCES source ... LIBRARIES library ... [PRECOMPILED]): the test test_NAME.
function(arfm_unit_test name)
  cmake_parse_arguments(TEST "PRECOMPILED" "" "SOURCES;LIBRARIES" ${ARGN})
  catkin_add_gtest(test_${name} ${TEST_SOURCES})
  arfm_prepare(test_${name} ${TEST_LIBRARIES} gtest_main gmock)
  if(TEST_PRECOMPILED)
    arfm_use_headers(test_${name} test_headers)
  endif()
endfunction()

# arfm_layer_test(LAYER [library ...] [PRECOMPILED] [TOGETHER]): the test test_LAYER of test/LAYER/*_test.cpp and the folders
# below it; TOGETHER: arfm_compile_together().
function(arfm_layer_test layer)
  cmake_parse_arguments(TEST "PRECOMPILED;TOGETHER" "" "" ${ARGN})
  file(GLOB_RECURSE sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/test/${layer}/*_test.cpp)
  if(TEST_PRECOMPILED)
    set(precompiled PRECOMPILED)
  endif()
  arfm_unit_test(${layer} SOURCES ${sources} LIBRARIES arfm_vo_${layer} ${TEST_UNPARSED_ARGUMENTS} ${precompiled})
  if(TEST_TOGETHER)
    arfm_compile_together(test_${layer})
  endif()
endfunction()

# arfm_test_program(NAME SOURCES source ... LIBRARIES library ... [BUILT]): a program for measurements or experiments; BUILT
# with the tests, so that it stays whole.
function(arfm_test_program name)
  cmake_parse_arguments(PROGRAM "BUILT" "" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} EXCLUDE_FROM_ALL ${PROGRAM_SOURCES})
  target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/test ${PROJECT_SOURCE_DIR}/src)
  target_link_libraries(${name} ${PROGRAM_LIBRARIES})
  if(PROGRAM_BUILT)
    add_dependencies(tests ${name})
  endif()
endfunction()

# arfm_node_test(NAME LAYER [SOURCES source ...] [NODES program ...]): the rostest NAME.test of this folder with the program
# test_NAME of NAME_test.cpp, which may have a main function of its own.
function(arfm_node_test name layer)
  cmake_parse_arguments(TEST "" "" "SOURCES;NODES" ${ARGN})
  add_rostest_gtest(test_${name} ${name}.test ${name}_test.cpp ${TEST_SOURCES})
  arfm_prepare(test_${name} arfm_vo_${layer} arfm_vo_node_test_main gtest gmock)
  arfm_use_headers(test_${name} test_headers)
  if(TEST_NODES)
    add_dependencies(test_${name} ${TEST_NODES})
  endif()
endfunction()

# arfm_script_test(NAME SCRIPT [argument ...]): the program SCRIPT of test/ as a test, in a shell that knows the package.
function(arfm_script_test name script)
  add_test(NAME ${name} COMMAND ${CATKIN_ENV} ${PROJECT_SOURCE_DIR}/test/${script} ${ARGN})
  set_tests_properties(${name} PROPERTIES SKIP_RETURN_CODE 77 TIMEOUT 900
    ENVIRONMENT "PYTHONPATH=/usr/lib/python3/dist-packages")
endfunction()

# arfm_isolate_tests([LONGEST name ...]): the tests of this folder may run side by side: each has a ROS_HOME
# of its own. (A rostest takes a free port for its master; our own tests ask for one, test/ports.py.) ctest starts the LONGEST
# first.
function(arfm_isolate_tests)
  cmake_parse_arguments(TESTS "" "" "LONGEST" ${ARGN})
  get_property(tests DIRECTORY PROPERTY TESTS)
  foreach(test ${tests})
    file(MAKE_DIRECTORY ${CMAKE_BINARY_DIR}/ros_home/${test})  # rospack makes the last folder only
    set_property(TEST ${test} APPEND PROPERTY ENVIRONMENT "ROS_HOME=${CMAKE_BINARY_DIR}/ros_home/${test}")
    string(REGEX REPLACE "^_ctest_.*(test_nodes_|gtest_test_)|\\.test$" "" name ${test})
    list(FIND TESTS_LONGEST ${name} place)
    if(NOT place EQUAL -1)
      math(EXPR cost "100 - ${place}")
      set_property(TEST ${test} PROPERTY COST ${cost})
    endif()
  endforeach()
endfunction()
