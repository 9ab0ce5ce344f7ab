#include "gnomon/scene/import_message.h"

#include <new>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

constexpr std::size_t kLongestName = 60;

}  // namespace

void bad_scene(const std::string& message) {
  throw Error(ErrorCode::kBadScene, message);
}

std::string in_quotes(std::string_view name) {
  std::size_t length = name.size();
  const bool cut = length > kLongestName;
  if (cut) {
    length = kLongestName;
    // Never in the middle of a UTF-8 character.
    while (length > 0 && (static_cast<unsigned char>(name[length]) & 0xC0U) == 0x80U) --length;
  }
  std::string text = "\"";
  for (const char c : name.substr(0, length)) {
    const auto byte = static_cast<unsigned char>(c);
    text += byte < 0x20U || byte == 0x7FU ? '?' : c;
  }
  return text + (cut ? "...\"" : "\"");
}

std::string numbered(std::string_view kind, std::size_t index, std::string_view name) {
  std::string text = std::string(kind) + ' ' + std::to_string(index);
  if (!name.empty()) text += ' ' + in_quotes(name);
  return text;
}

Scene run_import(const std::filesystem::path& file, const std::function<Scene()>& import) {
  const std::string prefix = file.empty() ? std::string() : file.string() + ": ";
  try {
    return import();
  } catch (const Error& error) {
    throw Error(error.code(), prefix + error.what());
  } catch (const std::bad_alloc&) {
    throw Error(ErrorCode::kOutOfMemory,
                prefix + "the scene does not fit into memory; split it or close other programs");
  } catch (const std::exception& error) {
    throw Error(ErrorCode::kBadScene, prefix + error.what());
  }
}

}  // namespace gnomon
