# Language, warnings and sanitizers for every target: link `understory_options`.
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
if(NOT CMAKE_BUILD_TYPE)
  set(CMAKE_BUILD_TYPE Release)
endif()
option(UNDERSTORY_WERROR "Warnings are errors (on in CI, off for people with other compilers)" OFF)
option(UNDERSTORY_SANITIZE "Address and undefined-behaviour sanitizers" OFF)

add_library(understory_options INTERFACE)
target_include_directories(understory_options INTERFACE ${PROJECT_SOURCE_DIR})
target_compile_definitions(understory_options INTERFACE GLM_FORCE_EXPLICIT_CTOR GLM_ENABLE_EXPERIMENTAL)
target_compile_options(understory_options INTERFACE -Wall -Wextra -Wshadow -Wconversion -Wno-sign-conversion
                                                    $<$<BOOL:${UNDERSTORY_WERROR}>:-Werror>)
# GCC 12 sees overlapping copies in every "text" + std::string (its bug 105651).
target_compile_options(understory_options INTERFACE $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)
if(UNDERSTORY_SANITIZE)
  target_compile_options(understory_options INTERFACE -fsanitize=address,undefined -fno-omit-frame-pointer)
  target_link_options(understory_options INTERFACE -fsanitize=address,undefined)
endif()
