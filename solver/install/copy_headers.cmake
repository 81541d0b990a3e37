# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DFROM="FOLDER;..." -DTO=FOLDER -P copy_headers.cmake: the headers in FROM, which include each other by their place
# in this project, "solver/...", for everybody else, who finds them in a folder esfem: "esfem/...".
cmake_minimum_required(VERSION 3.22)
file(GLOB_RECURSE left_over RELATIVE ${TO} ${TO}/*.hpp)
foreach(folder ${FROM})
  file(GLOB_RECURSE headers RELATIVE ${folder} ${folder}/*.hpp)
  list(REMOVE_ITEM left_over ${headers})
  foreach(header ${headers})
    file(READ ${folder}/${header} text)
    string(REPLACE "#include \"solver/" "#include \"esfem/" text "${text}")
    set(present "")
    if(EXISTS ${TO}/${header})
      file(READ ${TO}/${header} present)
    endif()
    # What is as it was stays untouched, and nobody who includes it is compiled again.
    if(NOT "${text}" STREQUAL "${present}")
      file(WRITE ${TO}/${header} "${text}")
    endif()
  endforeach()
endforeach()
foreach(header ${left_over})
  file(REMOVE ${TO}/${header})
endforeach()
