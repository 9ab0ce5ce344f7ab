#include "gnomon/render/png.h"

#include <stb_image_write.h>

#include <exception>

#include "gnomon/base/error.h"
#include "gnomon/scene/write_file.h"

namespace gnomon {
namespace {

struct Sink {
  std::vector<std::byte> bytes;
  bool full = false;  // no memory for them
};

// Called from C: nothing may be thrown through it.
void append(void* context, void* data, int size) noexcept {
  auto& sink = *static_cast<Sink*>(context);
  try {
    const auto* const first = static_cast<const std::byte*>(data);
    sink.bytes.insert(sink.bytes.end(), first, first + size);
  } catch (const std::exception&) {
    sink.full = true;
  }
}

}  // namespace

std::vector<std::byte> encode_png(const RgbImage& image) {
  Sink sink;
  const auto width = static_cast<int>(image.width);
  const int done = stbi_write_png_to_func(append, &sink, width, static_cast<int>(image.height), 3,
                                          image.bytes.data(), 3 * width);
  if (done == 0 || sink.full) throw Error(ErrorCode::kOutOfMemory, "no memory to encode the picture");
  return std::move(sink.bytes);
}

void write_png(const RgbImage& image, const std::filesystem::path& file) {
  write_file(file, encode_png(image));
}

}  // namespace gnomon
