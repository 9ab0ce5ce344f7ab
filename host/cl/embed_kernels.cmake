# Writes OUTPUT: a C++ file holding every kernel file, as the array embedded_kernels() returns.
# Run as: cmake -DROOT=kernels -DOUTPUT=file -P embed_kernels.cmake
file(GLOB_RECURSE files RELATIVE ${ROOT} ${ROOT}/*.cl ${ROOT}/*.h)
list(SORT files)
set(entries "")
foreach(file ${files})
  file(READ ${ROOT}/${file} text HEX)
  # Bytes, not a raw string: no length limit, no delimiter to collide with.
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${text}")
  string(MAKE_C_IDENTIFIER ${file} name)
  string(APPEND arrays "constexpr char k_${name}[] = {${bytes}'\\0'};\n")
  string(APPEND entries "    {\"${file}\", {k_${name}, sizeof k_${name} - 1}},\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from kernels/ by embed_kernels.cmake.
#include \"gnomon/cl/program.h\"
namespace gnomon::cl {
namespace {
${arrays}constexpr EmbeddedFile kFiles[] = {
${entries}};
}  // namespace
std::span<const EmbeddedFile> embedded_kernels() { return kFiles; }
}  // namespace gnomon::cl
")
