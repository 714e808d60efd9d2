# Headers of other libraries that most files include, compiled once: a full build takes about half the time. No header of the project is among them, so that
# a change of one rebuilds what includes it and nothing else. Files include what they use all the same: the preset `debug` builds without.
option(BURNISH_PRECOMPILE "Precompile the headers of the standard library, glm and fmt" ON)
set(burnish_precompiled algorithm array bit chrono cmath cstdint cstring filesystem functional limits map memory mutex numeric optional set span string string_view tuple
                        unordered_map utility variant vector fmt/format.h glm/glm.hpp glm/gtc/quaternion.hpp tl/expected.hpp)
list(TRANSFORM burnish_precompiled PREPEND "<")
list(TRANSFORM burnish_precompiled APPEND ">")

# burnish_precompile(TARGET OWNER [HEADER...]): the first call makes the headers in OWNER, the others use them. All targets of an owner have the same compile options.
function(burnish_precompile target owner)
  if(NOT BURNISH_PRECOMPILE)
    return()
  endif()
  if(target STREQUAL owner)
    target_precompile_headers(${target} PRIVATE ${burnish_precompiled} ${ARGN})
    target_link_libraries(${target} PRIVATE fmt::fmt)
  else()
    target_precompile_headers(${target} REUSE_FROM ${owner})
  endif()
  if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    target_compile_options(${target} PRIVATE $<$<COMPILE_LANGUAGE:CXX>:-fpch-preprocess>)  # for ccache
  endif()
endfunction()
