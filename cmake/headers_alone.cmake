# Target headers_alone compiles each header by itself: a header that leans on what others happen to include fails.
find_package(GTest REQUIRED)
find_package(VTK REQUIRED COMPONENTS CommonDataModel)
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} bench/*.hpp host/*.hpp kernels/*.hpp sim/*.hpp
     viz/*.hpp tests/*.hpp)
set(sources)
foreach(header ${headers})
  set(source ${PROJECT_BINARY_DIR}/headers_alone/${header}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n")
  list(APPEND sources ${source})
endforeach()
add_library(headers_alone OBJECT EXCLUDE_FROM_ALL ${sources})
target_link_libraries(headers_alone PRIVATE understory_options VTK::CommonDataModel)
# What tests/program/CMakeLists.txt tells its tests.
target_compile_definitions(headers_alone PRIVATE UNDERSTORY_PROGRAM="" UNDERSTORY_SCENES="")
