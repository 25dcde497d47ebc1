# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# promin_discover_suites(TARGET [GROUPS SUITE+SUITE...] [PROPERTIES NAME VALUE...]): adds a test of ctest for each group of
# suites of a GoogleTest program, and for each suite that is in no group. A group names the suites that use the same
# kernels. Where gtest_discover_tests has a process for each test, here a group or a suite has one: so its tests share a
# device, and with it every kernel that was compiled for an earlier test. The program itself runs a single test, with
# --gtest_filter.
function(promin_discover_suites TARGET)
  cmake_parse_arguments(PARSE_ARGV 1 ARG "" "" "GROUPS;PROPERTIES")
  set(FOLDER ${CMAKE_CURRENT_BINARY_DIR}/suites)
  set(LIST ${FOLDER}/${TARGET}_list.cmake)
  # The program is asked after it has been linked, and what it says is read when ctest starts.
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
# A suite stands at the beginning of a line, ends in a dot and may have its type behind it; its tests are indented.
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
