# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# promin_discover_suites(TARGET [NAME VALUE...]): a test of ctest for each suite of a GoogleTest program, with these
# properties. Where gtest_discover_tests has a process for each test, here a suite has one: so its tests share what
# SetUpTestSuite makes, a device above all and with it every kernel that was compiled for an earlier test. A single test
# is run by the program itself, with --gtest_filter.
function(promin_discover_suites TARGET)
  set(FOLDER ${CMAKE_CURRENT_BINARY_DIR}/suites)
  set(LIST ${FOLDER}/${TARGET}_list.cmake)
  # The program is asked after it has been linked, and what it says is read when ctest starts.
  add_custom_command(TARGET ${TARGET} POST_BUILD BYPRODUCTS ${LIST}
    COMMAND ${CMAKE_COMMAND} -D "PROGRAM=$<TARGET_FILE:${TARGET}>" -D "LIST=${LIST}" -D "PROPERTIES=${ARGN}"
            -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
    VERBATIM)
  file(WRITE ${FOLDER}/${TARGET}.cmake
"if(EXISTS \"${LIST}\")
  include(\"${LIST}\")
else()
  add_test(${TARGET}_NOT_BUILT ${TARGET}_NOT_BUILT)
endif()
")
  set_property(DIRECTORY APPEND PROPERTY TEST_INCLUDE_FILES ${FOLDER}/${TARGET}.cmake)
endfunction()

if(NOT CMAKE_SCRIPT_MODE_FILE STREQUAL CMAKE_CURRENT_LIST_FILE)
  return()
endif()

execute_process(COMMAND ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE SAID TIMEOUT 60 COMMAND_ERROR_IS_FATAL ANY)
# A suite stands at the beginning of a line, ends in a dot and may have its type behind it; its tests are indented.
string(REGEX MATCHALL "(^|\n)[A-Za-z_][A-Za-z0-9_/]*\\." SUITES "${SAID}")
if(NOT SUITES)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests tells of no suites:\n${SAID}")
endif()
list(JOIN PROPERTIES "\" \"" PROPERTIES)
set(TESTS)
foreach(SUITE IN LISTS SUITES)
  string(REGEX REPLACE "[\n.]" "" SUITE ${SUITE})
  string(APPEND TESTS "add_test(\"${SUITE}\" \"${PROGRAM}\" \"--gtest_filter=${SUITE}.*\")\n"
                      "set_tests_properties(\"${SUITE}\" PROPERTIES \"${PROPERTIES}\")\n")
endforeach()
file(WRITE ${LIST} "${TESTS}")
