# cmake -DOUTPUT=FILE.cpp -DROOT=DIR -DSOURCES="a.cl|shared/b.h" -P embed.cmake
# Writes the kernel sources as C++ string literals, each under its path below kernels/.
string(REPLACE "|" ";" names "${SOURCES}")
list(LENGTH names count)
set(text "#include \"kernels/embedded_table.hpp\"\n\nnamespace understory {\n\n")
string(APPEND text "const EmbeddedFile embedded_files[] = {\n")
foreach(name IN LISTS names)
  file(READ "${ROOT}/${name}" source)
  string(APPEND text "    {\"${name}\", R\"understory(${source})understory\"},\n")
endforeach()
string(APPEND text "};\nconst std::size_t embedded_file_count = ${count};\n\n}  // namespace understory\n")
file(WRITE "${OUTPUT}" "${text}")
