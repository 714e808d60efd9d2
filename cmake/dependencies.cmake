# Every library that the project takes from the distribution; docs/dependencies.md says what each is for.
find_package(glm REQUIRED)
find_package(tl-expected REQUIRED)
find_package(fmt REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(PNG REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(glfw3 REQUIRED)
find_package(Threads REQUIRED)
find_package(HWY REQUIRED CONFIG)
find_package(embree 3.13 REQUIRED)
# libjxl has no CMake package here.
find_path(JXL_INCLUDE_DIR jxl/butteraugli.h REQUIRED)
find_library(JXL_LIBRARY jxl REQUIRED)
add_library(JXL::JXL UNKNOWN IMPORTED)
set_target_properties(JXL::JXL PROPERTIES IMPORTED_LOCATION ${JXL_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${JXL_INCLUDE_DIR})
if(BURNISH_BUILD_TOOLS)
  find_path(IMGUI_INCLUDE_DIR imgui.h PATH_SUFFIXES imgui REQUIRED)  # with its GLFW and OpenGL backends
  find_library(IMGUI_LIBRARY imgui REQUIRED)
  find_library(STB_LIBRARY NAMES libstb.a REQUIRED)  # the font rasterizer that the distribution takes out of ImGui
endif()
find_path(KISSFFT_INCLUDE_DIR kissfft/kissfft.hh REQUIRED)  # header only

# What the public headers include.
add_library(burnish_public_deps INTERFACE)
target_link_libraries(burnish_public_deps INTERFACE glm::glm tl::expected)

# glad generates the OpenGL function table (one struct per context, nothing global) from the Khronos registry that its package carries.
# Debian installs it for /usr/bin/python3 as python3-glad; another Python is tried after that.
find_program(BURNISH_PYTHON NAMES python3 PATHS /usr/bin NO_DEFAULT_PATH)
find_program(BURNISH_PYTHON NAMES python3 REQUIRED)
set(glad_dir ${PROJECT_BINARY_DIR}/generated/glad)
if(NOT EXISTS ${glad_dir}/include/glad/gl.h)
  execute_process(COMMAND ${BURNISH_PYTHON} -m glad --quiet --out-path ${glad_dir} --reproducible
                          --api gl:core=4.5 --extensions GL_KHR_debug,GL_ARB_shader_draw_parameters,GL_EXT_texture_filter_anisotropic,GL_ARB_texture_filter_anisotropic,GL_KHR_parallel_shader_compile
                          c --mx --loader
                  RESULT_VARIABLE glad_result ERROR_VARIABLE glad_error)
  if(NOT glad_result EQUAL 0 OR NOT EXISTS ${glad_dir}/include/glad/gl.h)
    message(FATAL_ERROR "glad (the OpenGL loader generator) failed with ${BURNISH_PYTHON}: ${glad_error}\nInstall it: apt-get install python3-glad")
  endif()
endif()
