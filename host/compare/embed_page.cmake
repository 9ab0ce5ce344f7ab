# Writes OUTPUT: a C++ file holding page/style.css and page/script.js.
# Run as: cmake -DROOT=page -DOUTPUT=file -P embed_page.cmake
foreach(part style.css script.js)
  file(READ ${ROOT}/${part} text HEX)
  string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," bytes "${text}")
  string(MAKE_C_IDENTIFIER ${part} name)
  string(APPEND arrays "constexpr char k_${name}[] = {${bytes}'\\0'};\n")
endforeach()
file(WRITE ${OUTPUT} "// Generated from host/compare/page/ by embed_page.cmake.
#include \"gnomon/compare/page_parts.h\"
namespace gnomon::compare {
namespace {
${arrays}}  // namespace
std::string_view page_style() { return {k_style_css, sizeof k_style_css - 1}; }
std::string_view page_script() { return {k_script_js, sizeof k_script_js - 1}; }
}  // namespace gnomon::compare
")
