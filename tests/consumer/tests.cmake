# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# These tests use the library as another project does: installed, of both kinds, with CMake and with pkg-config, and as
# a folder of that project. All files lie outside the folders of the build, so that the library must find the plugin
# without them.
set(PROMIN_CONSUMER_DIR ${PROMIN_TESTS_BINARY_DIR}/consumer)
add_test(NAME Consumer.install
  COMMAND ${CMAKE_COMMAND} --install ${PROJECT_BINARY_DIR} --prefix ${PROMIN_CONSUMER_DIR}/prefix)
set_tests_properties(Consumer.install PROPERTIES FIXTURES_SETUP installed COST 100)
# promin_add_consumer(NAME OPTIONS...): builds tests/consumer with these options of CMake and runs it.
function(promin_add_consumer NAME)
  set(FOLDER ${PROMIN_CONSUMER_DIR}/${NAME})
  add_test(NAME Consumer.${NAME}
    COMMAND ${CMAKE_CTEST_COMMAND} --build-and-test ${PROMIN_TESTS_DIR}/consumer ${FOLDER}
            --build-generator Ninja --build-noclean --build-target consumer
            --build-options -DCMAKE_C_COMPILER=${CMAKE_CXX_COMPILER} ${ARGN}
            --test-command ${FOLDER}/consumer ${FOLDER}/picture.png)
  set_tests_properties(Consumer.${NAME} PROPERTIES FIXTURES_REQUIRED installed LABELS device TIMEOUT 600)
endfunction()
promin_add_consumer(finds_static -DPROMIN_KIND=static -DCMAKE_PREFIX_PATH=${PROMIN_CONSUMER_DIR}/prefix)
promin_add_consumer(finds_shared -DPROMIN_KIND=shared -DCMAKE_PREFIX_PATH=${PROMIN_CONSUMER_DIR}/prefix)
# The library is a part of the consumer. A test configures the consumer; a test with the label `long` also builds and
# runs it, which compiles the whole library once more.
set(PROMIN_AS_PART -DPROMIN_KIND=static -DPROMIN_SOURCE_DIR=${PROJECT_SOURCE_DIR} -DCMAKE_BUILD_TYPE=Release
    $<$<BOOL:${CCACHE}>:-DCMAKE_CXX_COMPILER_LAUNCHER=${CCACHE}>)
add_test(NAME Consumer.takes_the_sources_in
  COMMAND ${CMAKE_COMMAND} -G Ninja -S ${PROMIN_TESTS_DIR}/consumer -B ${PROMIN_CONSUMER_DIR}/sources_in
          -DCMAKE_CXX_COMPILER=${CMAKE_CXX_COMPILER} ${PROMIN_AS_PART})
promin_add_consumer(works_with_the_sources ${PROMIN_AS_PART})
set_tests_properties(Consumer.works_with_the_sources PROPERTIES LABELS "device;long" TIMEOUT 1800)
# These tests run under the validation layers, which write to the standard output if no program listens to them.
set_tests_properties(Consumer.finds_static PROPERTIES FIXTURES_SETUP consumer)
add_test(NAME Consumer.breaks_no_rule_of_Vulkan
  COMMAND ${Python3_EXECUTABLE} ${PROMIN_TESTS_DIR}/consumer/run_validated.py
          ${PROMIN_CONSUMER_DIR}/finds_static/consumer)
set_tests_properties(Consumer.breaks_no_rule_of_Vulkan PROPERTIES
  FIXTURES_REQUIRED "installed;consumer" LABELS device TIMEOUT 600 SKIP_RETURN_CODE 77)
foreach(TEST links_shared_by_pkg_config links_static_by_pkg_config builds_the_documented_program headers_stand_alone
        reference_is_complete shows_what_is_public)
  add_test(NAME Consumer.${TEST}
    COMMAND ${Python3_EXECUTABLE} ${PROMIN_TESTS_DIR}/consumer/consumer_test.py ${TEST}
            ${PROMIN_CONSUMER_DIR}/prefix ${PROMIN_CONSUMER_DIR}/${TEST} ${CMAKE_CXX_COMPILER})
  set_tests_properties(Consumer.${TEST} PROPERTIES
    FIXTURES_REQUIRED installed TIMEOUT 600 SKIP_RETURN_CODE 77)
  if("${TEST}" MATCHES "^links_shared")
    set_tests_properties(Consumer.${TEST} PROPERTIES LABELS device)
  elseif("${TEST}" MATCHES "^(links|builds)")
    set_tests_properties(Consumer.${TEST} PROPERTIES LABELS "device;long")
  elseif("${TEST}" STREQUAL "headers_stand_alone")
    set_tests_properties(Consumer.${TEST} PROPERTIES ENVIRONMENT ${PROMIN_NO_DRIVER} LABELS long)
  else()
    set_tests_properties(Consumer.${TEST} PROPERTIES ENVIRONMENT ${PROMIN_NO_DRIVER})
  endif()
endforeach()
