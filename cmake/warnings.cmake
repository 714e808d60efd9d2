# Warnings and sanitizers for every target of the project.
add_library(burnish_flags INTERFACE)
target_compile_options(burnish_flags INTERFACE -Wall -Wextra -Wpedantic -Wshadow $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor> -Wno-missing-field-initializers)
if(BURNISH_SANITIZE)
  target_compile_options(burnish_flags INTERFACE -fsanitize=${BURNISH_SANITIZE} -fno-sanitize-recover=undefined -fno-omit-frame-pointer)
  target_link_options(burnish_flags INTERFACE -fsanitize=${BURNISH_SANITIZE})
endif()
