# Writes OUTPUT, a header that names the commit of the checkout SOURCE: its short hash, "-dirty" when tracked files were
# changed since, "unknown" outside a checkout. Touches the file only when that changes.
cmake_minimum_required(VERSION 3.25)
set(commit unknown)
find_program(git_program git)
if(git_program)
  execute_process(COMMAND ${git_program} -C ${SOURCE} rev-parse --show-prefix --short=12 HEAD
                  OUTPUT_VARIABLE answer RESULT_VARIABLE failed ERROR_QUIET OUTPUT_STRIP_TRAILING_WHITESPACE)
  # The first line is SOURCE's place in the checkout: empty unless the checkout is somebody else's around ours.
  if(failed EQUAL 0 AND answer MATCHES "^\n([0-9a-f]+)$")
    set(commit ${CMAKE_MATCH_1})
    execute_process(COMMAND ${git_program} -C ${SOURCE} status --porcelain --untracked-files=no
                    OUTPUT_VARIABLE changes ERROR_QUIET)
    if(changes)
      string(APPEND commit "-dirty")
    endif()
  endif()
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT "// Written by write_commit.cmake.\n#pragma once\n#define GNOMON_COMMIT \"@commit@\"\n"
     @ONLY)
