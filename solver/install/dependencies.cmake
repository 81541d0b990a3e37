# SPDX-License-Identifier: GPL-3.0-or-later
# What the library is linked to, or its headers include: read here by CMakeLists.txt, and where it is installed by
# find_package(esfem).
include(CMakeFindDependencyMacro)
find_dependency(Eigen3 3.4 NO_MODULE)
find_dependency(nlohmann_json 3.11)
find_dependency(Threads)
# Where TBB is installed, Ceres' search for SuiteSparse would link it to everything, and nothing uses it.
set(esfem_without_TBB "${CMAKE_DISABLE_FIND_PACKAGE_TBB}")
set(CMAKE_DISABLE_FIND_PACKAGE_TBB ON)
find_dependency(Ceres 2)
set(CMAKE_DISABLE_FIND_PACKAGE_TBB "${esfem_without_TBB}")

# Debian has no CMake files of these.
set(esfem_required "")
if(esfem_FIND_REQUIRED)
  set(esfem_required REQUIRED)
endif()
find_path(UMFPACK_INCLUDE_DIR umfpack.h PATH_SUFFIXES suitesparse ${esfem_required})
foreach(library umfpack metis gmpxx gmp mpfr ginac cln)
  find_library(${library}_LIBRARY ${library} ${esfem_required})
  if(NOT ${library}_LIBRARY OR NOT UMFPACK_INCLUDE_DIR)
    set(esfem_FOUND FALSE)
    set(esfem_NOT_FOUND_MESSAGE "esfem needs the library ${library} and UMFPACK's header umfpack.h")
    return()
  endif()
  if(NOT TARGET esfem::${library})
    add_library(esfem::${library} UNKNOWN IMPORTED)
    set_target_properties(esfem::${library} PROPERTIES IMPORTED_LOCATION "${${library}_LIBRARY}")
  endif()
endforeach()
set_target_properties(esfem::umfpack PROPERTIES INTERFACE_INCLUDE_DIRECTORIES "${UMFPACK_INCLUDE_DIR}")
