# SPDX-License-Identifier: GPL-3.0-or-later
# find_package(esfem) gives the target esfem::esfem.
unset(esfem_NOT_FOUND_MESSAGE)
include("${CMAKE_CURRENT_LIST_DIR}/dependencies.cmake")
if(NOT esfem_NOT_FOUND_MESSAGE)
  include("${CMAKE_CURRENT_LIST_DIR}/esfemTargets.cmake")
endif()
