# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# Checks the system's packages. A user who builds with `pip install` has not run tools/setup. The message lists all
# missing packages at once, in one line, with their names in Debian and Ubuntu.
set(PROMIN_LACKING)
find_package(PkgConfig QUIET)
if(NOT PkgConfig_FOUND)
  list(APPEND PROMIN_LACKING pkg-config)
endif()
foreach(ROW libavif:libavif-dev libcrypto:libssl-dev libpng:libpng-dev libturbojpeg:libturbojpeg0-dev
            libwebp:libwebp-dev libzstd:libzstd-dev OpenEXR:libopenexr-dev OpenImageIO:libopenimageio-dev)
  string(REPLACE ":" ";" ROW ${ROW})
  list(GET ROW 0 MODULE)
  list(GET ROW 1 PACKAGE)
  if(PkgConfig_FOUND)
    pkg_check_modules(PROMIN_CHECKED_${MODULE} QUIET ${MODULE})
  endif()
  if(NOT PROMIN_CHECKED_${MODULE}_FOUND)
    list(APPEND PROMIN_LACKING ${PACKAGE})
  endif()
endforeach()
foreach(ROW CLI11:libcli11-dev fmt:libfmt-dev glm:libglm-dev SPIRV-Headers:spirv-headers nlohmann_json:nlohmann-json3-dev draco:libdraco-dev
            meshoptimizer:libmeshoptimizer-dev Vulkan:libvulkan-dev)
  string(REPLACE ":" ";" ROW ${ROW})
  list(GET ROW 0 MODULE)
  list(GET ROW 1 PACKAGE)
  find_package(${MODULE} QUIET)
  if(NOT ${MODULE}_FOUND)
    list(APPEND PROMIN_LACKING ${PACKAGE})
  endif()
endforeach()
find_program(PROMIN_CHECKED_GLSLANG NAMES glslangValidator glslang)
if(NOT PROMIN_CHECKED_GLSLANG)
  list(APPEND PROMIN_LACKING glslang-tools)
endif()
if(PROMIN_LACKING)
  list(JOIN PROMIN_LACKING " " PROMIN_LACKING)
  # CMake does not wrap indented lines of a message.
  message(FATAL_ERROR "promin needs system packages that are missing; as root run:\n  apt install ${PROMIN_LACKING}")
endif()
