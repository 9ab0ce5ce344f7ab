// Catch2 3 under version 2's name, with what these tests use of it: found instead of version 2's header where only version
// 3 is installed (Ubuntu 24.04). Not on the way of anything else.
#pragma once

#include <catch2/catch_all.hpp>
#include <string>

namespace Catch {

inline Matchers::StringContainsMatcher Contains(const std::string& text) {
  return Matchers::ContainsSubstring(text);
}
using Matchers::EndsWith;
using Matchers::StartsWith;

}  // namespace Catch

#ifdef CATCH_CONFIG_MAIN
int main(int argc, char** argv) {
  return Catch::Session().run(argc, argv);
}
#endif
