# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# promin_discover_suites(TARGET [GROUPS SUITE+SUITE...] [PROPERTIES NAME VALUE...]): adds a test of ctest for each group
# of suites of a GoogleTest program, and for each suite that is in no group. A group names the suites that use the same
# kernels. gtest_discover_tests has a process for each test; here a group or a suite has one. The tests of a process
# share a device and every kernel that an earlier test has compiled. To run a single test, give the program the option
# `--gtest_filter`.
function(promin_discover_suites TARGET)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "GROUPS;PROPERTIES")
  set(FOLDER ${CMAKE_CURRENT_BINARY_DIR}/suites)
  set(LIST ${FOLDER}/${TARGET}_list.cmake)
  # The program lists its suites after it has been linked; ctest reads the list when it starts.
  add_custom_command(TARGET ${TARGET} POST_BUILD BYPRODUCTS ${LIST}
    COMMAND ${CMAKE_COMMAND} -D "PROGRAM=$<TARGET_FILE:${TARGET}>" -D "LIST=${LIST}" -D "GROUPS=${ARG_GROUPS}"
            -D "PROPERTIES=${ARG_PROPERTIES}" -P ${CMAKE_CURRENT_FUNCTION_LIST_FILE}
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
# A suite's name is at the beginning of a line, ends in a dot and may be followed by its type; its tests are indented.
string(REGEX MATCHALL "(^|\n)[A-Za-z_][A-Za-z0-9_/]*\\." SUITES "${SAID}")
if(NOT SUITES)
  message(FATAL_ERROR "${PROGRAM} --gtest_list_tests tells of no suites:\n${SAID}")
endif()
list(TRANSFORM SUITES REPLACE "[\n.]" "")
foreach(GROUP IN LISTS GROUPS)
  string(REPLACE "+" ";" MEMBERS ${GROUP})
  foreach(MEMBER IN LISTS MEMBERS)
    list(FIND SUITES ${MEMBER} PLACE)
    if(PLACE EQUAL -1)
      message(FATAL_ERROR "${PROGRAM} has no suite ${MEMBER} of the group ${GROUP}")
    endif()
  endforeach()
  list(REMOVE_ITEM SUITES ${MEMBERS})
endforeach()
list(JOIN PROPERTIES "\" \"" PROPERTIES)
set(TESTS)
foreach(NAME IN LISTS GROUPS SUITES)
  string(REPLACE "+" ".*:" FILTER ${NAME})
  string(APPEND TESTS "add_test(\"${NAME}\" \"${PROGRAM}\" \"--gtest_filter=${FILTER}.*\")\n"
                      "set_tests_properties(\"${NAME}\" PROPERTIES \"${PROPERTIES}\")\n")
endforeach()
file(WRITE ${LIST} "${TESTS}")
