#include "gnomon/compare/pictures.h"

#include <algorithm>

#include "gnomon/render/camera_view.h"
#include "gnomon/render/heat_map.h"
#include "gnomon/render/png.h"
#include "gnomon/render/render.h"
#include "gnomon/render/tone.h"

namespace gnomon::compare {
namespace {

constexpr std::uint32_t kSamples = 4;

std::string png_bytes(const RgbImage& image) {
  const std::vector<std::byte> bytes = encode_png(image);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

}  // namespace

void draw_scene(const cl::Context& context, const Scene& scene, const DeviceBvh& tree, std::uint32_t width,
                std::uint32_t height, std::uint64_t seed, Pictures& pictures, const Progress& progress) {
  RenderOptions options;
  options.width = width;
  options.height = height;
  options.samples = kSamples;
  options.seed = seed;
  const RenderResult result = render(context, tree, scene, options, progress);
  pictures.png[""] = png_bytes(tone_map(result.picture, auto_exposure(result.picture, result.coverage)));
  pictures.width = width;
  pictures.height = height;
}

void draw_heat_maps(const Scene& scene, const std::vector<std::pair<std::string, Entrant*>>& methods,
                    Pictures& pictures) {
  const CameraView view(scene.cameras.empty() ? default_camera(scene) : scene.cameras.front(), pictures.width,
                        pictures.height);
  std::vector<Ray> rays;
  for (std::uint32_t y = 0; y < pictures.height; ++y)
    for (std::uint32_t x = 0; x < pictures.width; ++x) rays.push_back(view.ray(x + 0.5, y + 0.5));
  std::vector<std::pair<std::string, std::vector<float>>> maps;
  std::vector<float> all;
  for (const auto& [name, entrant] : methods) {
    std::vector<float> boxes = entrant->boxes(rays);
    if (boxes.empty()) continue;
    if (std::any_of(maps.begin(), maps.end(), [&](const auto& map) { return map.second == boxes; })) continue;
    all.insert(all.end(), boxes.begin(), boxes.end());
    maps.emplace_back(name, std::move(boxes));
  }
  const HeatScale scale = heat_scale(all);
  pictures.white = scale.white;
  for (const auto& [name, boxes] : maps) {
    pictures.png[name] = png_bytes(heat_map(pictures.width, pictures.height, boxes, scale));
    pictures.mean[name] = heat_scale(boxes).mean;
  }
}

}  // namespace gnomon::compare
