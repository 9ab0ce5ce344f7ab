// Memory of large buffers: kept for the next ones up to a limit, and never for two at a time.
#include <catch2/catch.hpp>

#include "gnomon/cl/large_pages.h"
#include "support/device.h"

using gnomon::test::context;

namespace {
constexpr std::size_t kPage = std::size_t{2} << 20U;
}  // namespace

// Drivers may release later than asked to; PoCL does so at once.
TEST_CASE("what large buffers give back is kept up to the limit, and given out again", "[unlimited]") {
  const gnomon::cl::LargePages pages(2 * kPage);
  auto a = pages.create(context().context(), kPage);
  auto b = pages.create(context().context(), kPage + 1);
  auto c = pages.create(context().context(), kPage);
  REQUIRE(a.get() != nullptr);
  REQUIRE(pages.spare_bytes() == 0);
  a = {};
  REQUIRE(pages.spare_bytes() == kPage);
  c = {};
  REQUIRE(pages.spare_bytes() == 2 * kPage);
  b = {};  // makes the other two leave
  REQUIRE(pages.spare_bytes() == 2 * kPage);
  a = pages.create(context().context(), kPage);  // half of what is kept would be wasted
  REQUIRE(pages.spare_bytes() == 2 * kPage);
  b = pages.create(context().context(), 2 * kPage);
  REQUIRE(pages.spare_bytes() == 0);
  auto large = pages.create(context().context(), 3 * kPage);
  large = {};  // more than may be kept
  REQUIRE(pages.spare_bytes() == 0);
}

TEST_CASE("a buffer may outlive the store its memory came from", "[unlimited]") {
  gnomon::cl::Handle<cl_mem> buffer;
  {
    const gnomon::cl::LargePages pages(kPage);
    buffer = pages.create(context().context(), kPage);
  }
  REQUIRE(buffer.get() != nullptr);
  buffer = {};
}

TEST_CASE("a context told to keep nothing has buffers all the same", "[unlimited]") {
  gnomon::cl::ContextOptions options;
  options.spare_bytes = 0;
  const gnomon::cl::Context frugal(gnomon::test::chosen_device(), options);
  const auto one = frugal.create_buffer("one", 3 * kPage);
  const std::vector<std::uint32_t> words{1, 2, 3};
  frugal.upload_values<std::uint32_t>(one, words);
  REQUIRE(frugal.download_values<std::uint32_t>(one, 3) == words);
}
