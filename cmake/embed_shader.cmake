# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# cmake -DSPIRV_OPT=PROGRAM -DINPUT=FILE.spv -DNAME=NAME -DOUTPUT=FILE.h -P embed_shader.cmake
# Optimizes a SPIR-V module and writes it as the C++ array k_NAME_spirv.
#
# glslang writes a call for each call, and a variable for each argument, struct and result. A driver spends most of its
# time on removing them, at each start of a program. So spirv-opt inlines the functions that have one return, and
# replaces loads of local variables with the values that were stored there. No pass changes an operation on floats:
# --simplify-instructions, which is part of -O and -Os, may do so. --merge-return would make three times as many words.
# With --ssa-rewrite lavapipe 25 traces mirror rays in 1.4 times the time.
execute_process(
  COMMAND ${SPIRV_OPT} --target-env=vulkan1.1 --preserve-spec-constants
          --inline-entry-points-exhaustive --eliminate-dead-functions --convert-local-access-chains
          --eliminate-local-single-block --eliminate-local-single-store --eliminate-dead-code-aggressive
          ${INPUT} -o ${OUTPUT}.spv
  # A warning for each function that has several returns.
  OUTPUT_VARIABLE MESSAGES
  ERROR_VARIABLE MESSAGES
  RESULT_VARIABLE STATUS)
if(NOT STATUS EQUAL 0)
  message(FATAL_ERROR "${SPIRV_OPT} failed on ${INPUT}: ${STATUS}\n${MESSAGES}")
endif()
file(READ ${OUTPUT}.spv WORDS HEX)
string(REGEX REPLACE "(..)(..)(..)(..)" "0x\\4\\3\\2\\1," WORDS "${WORDS}")
file(WRITE ${OUTPUT} "#pragma once\n#include <cstdint>\ninline constexpr uint32_t k_${NAME}_spirv[] = {${WORDS}};\n")
