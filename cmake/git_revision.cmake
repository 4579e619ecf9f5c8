# Writes the git revision of SOURCE as a header to OUTPUT, which is touched only if the revision has changed.
set(REVISION unknown)
find_program(GIT git)
if(GIT)
  execute_process(COMMAND ${GIT} -C ${SOURCE} describe --always --dirty --abbrev=12 --exclude=*
    OUTPUT_VARIABLE described OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE problem)
  if(problem EQUAL 0)
    set(REVISION ${described})
  endif()
endif()
file(WRITE ${OUTPUT}.new "#pragma once\n\nnamespace semantic_mht_slam {\n\nconstexpr const char* kGitRevision = \"${REVISION}\";\n\n}  // namespace semantic_mht_slam\n")
execute_process(COMMAND ${CMAKE_COMMAND} -E copy_if_different ${OUTPUT}.new ${OUTPUT})
