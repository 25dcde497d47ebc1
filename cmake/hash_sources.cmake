# SPDX-FileCopyrightText: The promin developers
# SPDX-License-Identifier: Apache-2.0

# cmake -DROOT=FOLDER -DLIST=FILE -DOUTPUT=FILE.cpp -P hash_sources.cmake: writes app/sources_hash.h's constant, the hash
# of the names and contents of the files that LIST names, a line each, below ROOT.
cmake_minimum_required(VERSION 3.25)
file(STRINGS ${LIST} FILES)
list(SORT FILES)
set(TEXT)
foreach(FILE IN LISTS FILES)
  file(SHA256 ${ROOT}/${FILE} HASH)
  string(APPEND TEXT "${FILE} ${HASH}\n")
endforeach()
string(SHA256 HASH "${TEXT}")
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
"#include \"sources_hash.h\"

namespace promin::app {

const std::string_view kSourcesHash = \"@HASH@\";

}  // namespace promin::app
" @ONLY)
