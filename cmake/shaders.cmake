# Embeds shaders/ into the library as text: generated/embedded_shaders.cpp.
file(GLOB_RECURSE burnish_shader_files CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR}/shaders
     ${PROJECT_SOURCE_DIR}/shaders/*.h ${PROJECT_SOURCE_DIR}/shaders/*.glsl ${PROJECT_SOURCE_DIR}/shaders/*.vert ${PROJECT_SOURCE_DIR}/shaders/*.frag ${PROJECT_SOURCE_DIR}/shaders/*.comp)
list(TRANSFORM burnish_shader_files PREPEND ${PROJECT_SOURCE_DIR}/shaders/ OUTPUT_VARIABLE burnish_shader_paths)
# A file that was moved or removed is no newer than the output: the list itself is a dependency.
string(REPLACE ";" "\n" burnish_shader_list "${burnish_shader_files}")
file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/generated/shader_files.txt CONTENT "${burnish_shader_list}\n" @ONLY)
add_custom_command(
  OUTPUT ${PROJECT_BINARY_DIR}/generated/embedded_shaders.cpp
  COMMAND ${BURNISH_PYTHON} ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.py ${PROJECT_SOURCE_DIR}/shaders ${PROJECT_BINARY_DIR}/generated/embedded_shaders.cpp
  DEPENDS ${burnish_shader_paths} ${PROJECT_BINARY_DIR}/generated/shader_files.txt ${PROJECT_SOURCE_DIR}/cmake/embed_shaders.py
  COMMENT "Embedding shaders")
