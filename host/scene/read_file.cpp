#include "gnomon/scene/read_file.h"

#include <fstream>
#include <string>
#include <system_error>

#include "gnomon/base/error.h"

namespace gnomon {
namespace {

[[noreturn]] void cannot_read(const std::filesystem::path& file, const std::string& why) {
  throw Error(ErrorCode::kIo, "cannot read " + file.string() + ": " + why);
}

std::vector<unsigned char> make_room(const std::filesystem::path& file, std::uintmax_t size) {
  try {
    return std::vector<unsigned char>(static_cast<std::size_t>(size));
  } catch (const std::exception&) {  // bad_alloc or length_error
    throw Error(ErrorCode::kOutOfMemory,
                "no memory for the " + std::to_string(size) + " bytes of " + file.string());
  }
}

}  // namespace

std::vector<unsigned char> read_file(const std::filesystem::path& file, std::uint64_t at_most) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (status.type() == std::filesystem::file_type::not_found) cannot_read(file, "there is no such file");
  if (error) cannot_read(file, error.message());
  if (std::filesystem::is_directory(status)) cannot_read(file, "it is a folder");
  if (!std::filesystem::is_regular_file(status)) cannot_read(file, "it is not a regular file");
  const std::uintmax_t file_size = std::filesystem::file_size(file, error);
  if (error) cannot_read(file, error.message());
  std::ifstream stream(file, std::ios::binary);
  if (!stream) cannot_read(file, "permission denied, or the file is in use");
  auto bytes = make_room(file, file_size < at_most ? file_size : at_most);
  stream.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (stream.gcount() != static_cast<std::streamsize>(bytes.size()))
    cannot_read(file, "reading stopped early");
  return bytes;
}

}  // namespace gnomon
