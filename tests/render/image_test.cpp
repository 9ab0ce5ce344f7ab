// From values to bytes: exposure, tone, heat colours, PNG.
#include <stb_image.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <limits>

#include "gnomon/base/error.h"
#include "gnomon/render/heat_map.h"
#include "gnomon/render/png.h"
#include "gnomon/render/render.h"
#include "gnomon/render/tone.h"

using namespace gnomon;

namespace {

Picture grey(std::uint32_t width, float value) {
  return {width, 1, std::vector<Vec3>(width, {value, value, value})};
}

}  // namespace

TEST_CASE("exposure makes a grey picture look the same however bright it is") {
  const auto shown = [](float value) {
    return tone_map(grey(9, value), auto_exposure(grey(9, value))).bytes[0];
  };
  CHECK(shown(1e-4F) == shown(1.0F));
  CHECK(shown(1e4F) == shown(1.0F));
  CHECK(shown(1.0F) > 100);
  CHECK(shown(1.0F) < 190);
  CHECK(auto_exposure(grey(4, 0.0F)) == 1.0);
  CHECK(auto_exposure(Picture{}) == 1.0);
}

TEST_CASE("only pixels with weight decide the exposure") {
  Picture picture = grey(10, 1.0F);
  for (std::size_t i = 5; i < 10; ++i) picture.pixels[i] = {100.0F, 100.0F, 100.0F};
  std::vector<float> weights(10, 0.0F);
  std::fill(weights.begin(), weights.begin() + 5, 1.0F);
  CHECK(auto_exposure(picture, weights) == Approx(auto_exposure(grey(5, 1.0F))));
  CHECK(auto_exposure(picture) < 0.5 * auto_exposure(picture, weights));
}

TEST_CASE("brighter light never looks darker, and what is no number is black") {
  Picture ramp{100, 1, {}};
  for (int i = 0; i < 100; ++i) ramp.pixels.push_back({0.1F * static_cast<float>(i), 0.0F, 0.0F});
  const RgbImage image = tone_map(ramp, 1.0);
  REQUIRE(image.bytes.size() == 300);
  for (std::size_t i = 1; i < 100; ++i) {
    CAPTURE(i);
    CHECK(image.bytes[3 * i] >= image.bytes[3 * i - 3]);
  }
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float infinity = std::numeric_limits<float>::infinity();
  const RgbImage odd = tone_map({1, 1, {{nan, infinity, -1.0F}}}, 1.0);
  CHECK(odd.bytes == std::vector<std::uint8_t>{0, 0, 0});
  CHECK(auto_exposure({2, 1, {{nan, nan, nan}, {1.0F, 1.0F, 1.0F}}}) > 0.0);
}

TEST_CASE("sRGB bytes are those of the standard, and stay in range") {
  const auto byte = [](double linear) { return static_cast<int>(to_srgb_byte(linear)); };
  CHECK(byte(-1.0) == 0);
  CHECK(byte(0.0) == 0);
  CHECK(byte(0.002) == 7);        // the straight part: 12.92 * 0.002 * 255
  CHECK(byte(0.2158605) == 128);  // ((128 / 255 + 0.055) / 1.055) ^ 2.4
  CHECK(byte(1.0) == 255);
  CHECK(byte(7.0) == 255);
}

TEST_CASE("heat colours get lighter all the way") {
  double last = -1.0;
  for (int i = 0; i <= 64; ++i) {
    const auto color = heat_color(i / 64.0);
    const auto linear = [&](std::size_t k) { return std::pow(color[k] / 255.0, 2.2); };
    const double light = 0.2126 * linear(0) + 0.7152 * linear(1) + 0.0722 * linear(2);
    CAPTURE(i);
    CHECK(light > last);
    last = light;
  }
  CHECK(heat_color(-1.0) == heat_color(0.0));
  CHECK(heat_color(2.0) == heat_color(1.0));
  CHECK(heat_color(std::nan("")) == heat_color(0.0));
}

TEST_CASE("a heat map's scale ignores a few outliers but reports them") {
  std::vector<float> values(1000, 10.0F);
  values[3] = 500.0F;
  const HeatScale scale = heat_scale(values);
  CHECK(scale.max == 500.0);
  CHECK(scale.white == 10.0);
  CHECK(scale.mean == Approx(10.49));
  const RgbImage image = heat_map(1000, 1, values, scale);
  const auto brightest = heat_color(1.0);
  CHECK(std::equal(brightest.begin(), brightest.end(), image.bytes.begin()));
  CHECK(heat_scale({}).max == 0.0);
  CHECK(heat_map(2, 1, std::vector<float>{0.0F, 0.0F}, HeatScale{}).bytes.size() == 6);
}

TEST_CASE("a PNG decodes to the bytes it was made of") {
  RgbImage image{5, 3, {}};
  for (unsigned i = 0; i < 45; ++i) image.bytes.push_back(static_cast<std::uint8_t>(37 * i));
  const std::vector<std::byte> file = encode_png(image);
  int width = 0, height = 0, channels = 0;
  unsigned char* const decoded =
      stbi_load_from_memory(reinterpret_cast<const unsigned char*>(file.data()),
                            static_cast<int>(file.size()), &width, &height, &channels, 0);
  REQUIRE(decoded != nullptr);
  CHECK(width == 5);
  CHECK(height == 3);
  CHECK(channels == 3);
  CHECK(std::equal(image.bytes.begin(), image.bytes.end(), decoded));
  stbi_image_free(decoded);
  CHECK_THROWS_AS(write_png(image, "/nonexistent/a.png"), Error);
}

TEST_CASE("picture sizes out of range are refused by name") {
  const auto refused = [](std::uint32_t width, std::uint32_t height, std::uint32_t samples) {
    RenderOptions options;
    options.width = width;
    options.height = height;
    options.samples = samples;
    CHECK_THROWS_AS(options.check(), Error);
  };
  CHECK_NOTHROW(RenderOptions{}.check());
  refused(0, 10, 1);
  refused(16385, 10, 1);
  refused(10, 16385, 1);
  refused(16384, 16384, 1);
  refused(10, 10, 0);
  refused(10, 10, 4097);
}
