# SPDX-License-Identifier: GPL-3.0-or-later
# Writes OUTPUT with what identifies a build, only when that has changed. Run at every build:
# cmake -DSOURCE=... -DOUTPUT=... -DVERSION=... -DCOMPILER=... -DFLAGS=... -P provenance.cmake
get_filename_component(parent ${SOURCE} DIRECTORY)
set(ENV{GIT_CEILING_DIRECTORIES} ${parent}) # a repository around an unpacked archive is not ours
find_program(GIT git)
set(commit unknown)
set(dirty false)
if(GIT)
  execute_process(COMMAND ${GIT} rev-parse HEAD WORKING_DIRECTORY ${SOURCE} RESULT_VARIABLE failed
                  OUTPUT_VARIABLE head OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
  if(NOT failed)
    set(commit ${head})
    # What numbers depend on; a note beside the sources does not make a result doubtful.
    execute_process(COMMAND ${GIT} status --porcelain -- solver experiments CMakeLists.txt
                    WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      set(dirty true)
    endif()
  endif()
endif()
string(REGEX REPLACE " +" " " FLAGS "${FLAGS}")
string(STRIP "${FLAGS}" FLAGS)
string(REPLACE "\"" "\\\"" FLAGS "${FLAGS}")
set(text "{\"version\": \"${VERSION}\", \"git\": \"${commit}\", \"dirty\": ${dirty},
 \"compiler\": \"${COMPILER}\", \"flags\": \"${FLAGS}\"}\n")
set(old "")
if(EXISTS ${OUTPUT})
  file(READ ${OUTPUT} old)
endif()
if(NOT text STREQUAL old)
  file(WRITE ${OUTPUT} "${text}")
endif()
