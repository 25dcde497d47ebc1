# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# Compiles at most 32 sources of a target together (CMake's unity builds), of a larger target those of a folder and its
# subfolders. A header is then parsed once for all of them, and a template that many of them use is compiled once. The
# options are the same.

# The file lists the groups of sources for tools/joined_names, one source a line: TARGET/GROUP FILE.
set(PROMIN_JOINED_SOURCES ${CMAKE_BINARY_DIR}/joined_sources.txt)
file(WRITE ${PROMIN_JOINED_SOURCES} "")

# promin_join_sources(FOLDER): does so for the targets of FOLDER's CMakeLists.txt and of those below it if
# PROMIN_JOIN_SOURCES is set. Otherwise only lists their groups.
function(promin_join_sources FOLDER)
  get_directory_property(TARGETS DIRECTORY ${FOLDER} BUILDSYSTEM_TARGETS)
  foreach(NAME IN LISTS TARGETS)
    get_target_property(TYPE ${NAME} TYPE)
    if(TYPE MATCHES "^(EXECUTABLE|(STATIC|OBJECT|MODULE)_LIBRARY)$")
      promin_join_sources_of(${NAME})
    endif()
  endforeach()
  get_directory_property(SUBDIRECTORIES DIRECTORY ${FOLDER} SUBDIRECTORIES)
  foreach(SUBDIRECTORY IN LISTS SUBDIRECTORIES)
    promin_join_sources(${SUBDIRECTORY})
  endforeach()
endfunction()

function(promin_join_sources_of NAME)
  get_target_property(SOURCES ${NAME} SOURCES)
  list(FILTER SOURCES INCLUDE REGEX "\\.cpp$")
  list(SORT SOURCES)
  get_target_property(SOURCE_FOLDER ${NAME} SOURCE_DIR)
  list(LENGTH SOURCES LENGTH)
  set(GROUPS)
  set(LIST "")
  foreach(SOURCE IN LISTS SOURCES)
    set(GROUP)
    if(LENGTH GREATER 32)
      string(REGEX MATCH "^(\\.\\./)?[^/]+/" GROUP "${SOURCE}")
    endif()
    string(MAKE_C_IDENTIFIER "in_${GROUP}" GROUP)
    list(APPEND GROUPS ${GROUP})
    list(APPEND ${GROUP} ${SOURCE})
  endforeach()
  list(REMOVE_DUPLICATES GROUPS)
  foreach(GROUP IN LISTS GROUPS)
    list(LENGTH ${GROUP} LENGTH)
    if(LENGTH EQUAL 1)
      continue()
    endif()
    # Parts of equal size.
    math(EXPR PARTS "(${LENGTH} + 31) / 32")
    set(INDEX 0)
    foreach(SOURCE IN LISTS ${GROUP})
      math(EXPR PART "${INDEX} * ${PARTS} / ${LENGTH}")
      set_source_files_properties(${SOURCE_FOLDER}/${SOURCE} TARGET_DIRECTORY ${NAME}
        PROPERTIES UNITY_GROUP ${GROUP}_${PART})
      string(APPEND LIST "${NAME}/${GROUP}_${PART} ${SOURCE_FOLDER}/${SOURCE}\n")
      math(EXPR INDEX "${INDEX} + 1")
    endforeach()
  endforeach()
  file(APPEND ${PROMIN_JOINED_SOURCES} "${LIST}")
  if(NOT PROMIN_JOIN_SOURCES)
    return()
  endif()
  set_target_properties(${NAME} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  # GCC takes a source that another includes for a header, in which an unnamed namespace would be a mistake.
  target_compile_options(${NAME} PRIVATE -Wno-subobject-linkage)
endfunction()
