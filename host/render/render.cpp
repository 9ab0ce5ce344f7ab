#include "gnomon/render/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gnomon/render/camera_view.h"
#include "gnomon/render/light_set.h"
#include "gnomon/render/sample_pattern.h"
#include "gnomon/render/sky.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kTileRays = 1U << 18U;    // camera rays traced at a time
constexpr std::size_t kLightsPerSample = 8;
constexpr double kOffset = 1e-5;                  // of shadow rays' origins, in diagonals, as in ray_set.h
constexpr double kShadowReach = 0.9999;           // of the distance to a light: its own surface does not hide it
constexpr double kOpenness = 0.03;                // diagonals at which a surface opposite dims ambient light by half

// What sample_point's numbers are for.
enum Purpose : std::uint32_t { kPixel, kAmbient, kLightChoice, kLightPoint };

// Where a camera ray hit, moved off the surface to the side it came from.
struct Place {
  Point position;
  Point normal;  // unit, on that side
  Point albedo;
  std::uint32_t pixel;   // within the tile
  std::uint32_t sample;
};

// Light on its way to a pixel, if the ray of the same index is free.
struct Pending {
  std::uint32_t pixel;
  Point radiance;
};

struct Tile {
  std::uint32_t x, y, width, height;
};

Ray make_ray(const Point& origin, const Point& direction, double tmax) {
  Ray ray{};
  for (int axis = 0; axis < 3; ++axis) {
    ray.origin[axis] = static_cast<float>(origin[axis]);
    ray.direction[axis] = static_cast<float>(direction[axis]);
  }
  ray.tmax = static_cast<float>(tmax);
  return ray;
}

class Renderer {
 public:
  Renderer(const cl::Context& context, const DeviceBvh& tree, const Scene& scene, const RenderOptions& options)
      : scene_(scene),
        options_(options),
        tracer_(context, tree),
        bounds_(bounds_of(scene)),
        lights_(scene, bounds_),
        sky_(lights_.sky_level()),
        view_(scene.cameras.empty() ? default_camera(scene) : scene.cameras.front(), options.width, options.height) {
    if (options.heat_map) {
      TraceOptions counting;
      counting.counters = true;
      counting_tracer_.emplace(context, tree, counting);
    }
    if (!scene.triangles.empty()) diagonal_ = glm::length(to_point(bounds_.hi) - to_point(bounds_.lo));
    if (!lights_.note().empty()) result_.notes.push_back(lights_.note());
    if (scene.cameras.empty()) result_.notes.emplace_back("the scene has no camera: a default one sees all of it");
  }

  RenderResult run(const Progress& progress) {
    const std::size_t pixels = std::size_t{options_.width} * options_.height;
    result_.picture = {options_.width, options_.height, std::vector<Vec3>(pixels)};
    if (options_.heat_map) result_.boxes.resize(pixels);
    const std::vector<Tile> tiles = cut_tiles();
    for (std::size_t i = 0; i < tiles.size(); ++i) {
      render_tile(tiles[i], [&](std::string_view, double done) {
        return !progress || progress("render", (static_cast<double>(i) + done) / static_cast<double>(tiles.size()));
      });
    }
    return std::move(result_);
  }

 private:
  [[nodiscard]] std::vector<Tile> cut_tiles() const {
    const auto side = static_cast<std::uint32_t>(std::sqrt(kTileRays / options_.samples));
    std::vector<Tile> tiles;
    for (std::uint32_t y = 0; y < options_.height; y += side) {
      for (std::uint32_t x = 0; x < options_.width; x += side) {
        tiles.push_back({x, y, std::min(side, options_.width - x), std::min(side, options_.height - y)});
      }
    }
    return tiles;
  }

  // The pixel's number in the whole picture: what its random numbers depend on.
  [[nodiscard]] std::uint64_t picture_pixel(const Tile& tile, std::uint32_t pixel) const {
    return (std::uint64_t{tile.y} + pixel / tile.width) * options_.width + tile.x + pixel % tile.width;
  }

  [[nodiscard]] Point2 random_point(const Tile& tile, const Place& place, std::uint32_t purpose) const {
    return sample_point(options_.seed, picture_pixel(tile, place.pixel), purpose, place.sample);
  }

  void render_tile(const Tile& tile, const Progress& progress) {
    sums_.assign(std::size_t{tile.width} * tile.height, Point{0.0});
    report(progress, "camera", 0.0);
    const std::vector<Place> places = trace_camera(tile);
    report(progress, "ambient", 0.2);
    add_ambient(tile, places);
    const std::size_t rounds = std::min(kLightsPerSample, lights_.size());
    for (std::size_t round = 0; round < rounds; ++round) {
      report(progress, "lights", 0.4 + 0.6 * static_cast<double>(round) / static_cast<double>(rounds));
      add_lights(tile, places, round, rounds);
    }
    for (std::uint32_t pixel = 0; pixel < sums_.size(); ++pixel) {
      result_.picture.pixels[picture_pixel(tile, pixel)] = to_vec3(sums_[pixel] / static_cast<double>(options_.samples));
    }
  }

  // Camera rays: what they see directly goes into the sums, the surfaces they hit come back.
  [[nodiscard]] std::vector<Place> trace_camera(const Tile& tile) {
    std::vector<Ray> rays;
    rays.reserve(sums_.size() * options_.samples);
    for (std::uint32_t pixel = 0; pixel < sums_.size(); ++pixel) {
      for (std::uint32_t sample = 0; sample < options_.samples; ++sample) {
        const Point2 at = sample_point(options_.seed, picture_pixel(tile, pixel), kPixel, sample);
        rays.push_back(view_.ray(tile.x + pixel % tile.width + at.x, tile.y + pixel / tile.width + at.y));
      }
    }
    const TraceResult traced = (counting_tracer_ ? *counting_tracer_ : tracer_).closest(rays);
    count(traced, rays.size(), result_.camera_rays);
    std::vector<Place> places;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const std::uint32_t pixel = i / options_.samples;
      if (!traced.counters.empty()) {
        result_.boxes[picture_pixel(tile, pixel)] +=
            static_cast<float>(traced.counters[i].boxes) / static_cast<float>(options_.samples);
      }
      if (traced.hits[i].primitive == GN_NONE) {
        sums_[pixel] += sky_.radiance(to_point(rays[i].direction));
      } else {
        places.push_back(place_of(rays[i], traced.hits[i], pixel, i % options_.samples));
        sums_[pixel] += to_point(material_of(traced.hits[i]).emission);
      }
    }
    return places;
  }

  [[nodiscard]] const Material& material_of(const Hit& hit) const {
    return scene_.materials[scene_.material_ids[hit.primitive]];
  }

  [[nodiscard]] Place place_of(const Ray& ray, const Hit& hit, std::uint32_t pixel, std::uint32_t sample) const {
    const Triangle& t = scene_.triangles[hit.primitive];
    const Point v0 = to_point(t.v0);
    const Point e1 = to_point(t.v1) - v0;
    const Point e2 = to_point(t.v2) - v0;
    Point normal = glm::cross(e1, e2);
    const double length = glm::length(normal);
    normal = length > 0.0 ? normal / length : -to_point(ray.direction);
    if (glm::dot(normal, to_point(ray.direction)) > 0.0) normal = -normal;
    const Point surface = v0 + static_cast<double>(hit.u) * e1 + static_cast<double>(hit.v) * e2;
    return {surface + kOffset * diagonal_ * normal, normal, to_point(material_of(hit).base_color), pixel, sample};
  }

  // One ray a place, cosine-weighted: sky where it is free; else a guess at bounced light, dimmer where the surface
  // opposite is near (Zhukov et al. 1998, obscurances).
  void add_ambient(const Tile& tile, const std::vector<Place>& places) {
    std::vector<Ray> rays;
    rays.reserve(places.size());
    for (const Place& place : places) {
      const Point direction = cosine_direction(place.normal, random_point(tile, place, kAmbient));
      rays.push_back(make_ray(place.position, direction, std::numeric_limits<double>::infinity()));
    }
    const TraceResult traced = tracer_.closest(rays);
    count(traced, rays.size(), result_.other_rays);
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Hit& hit = traced.hits[i];
      Point light = sky_.radiance(to_point(rays[i].direction));
      if (hit.primitive != GN_NONE) {
        const double open = static_cast<double>(hit.t) / (static_cast<double>(hit.t) + kOpenness * diagonal_);
        light = open * sky_.bounced() * to_point(material_of(hit).base_color);
      }
      sums_[places[i].pixel] += places[i].albedo * light;
    }
  }

  // One shadow ray a place to one light: light number `round`, or one of its share when there are many.
  void add_lights(const Tile& tile, const std::vector<Place>& places, std::size_t round, std::size_t rounds) {
    std::vector<Ray> rays;
    std::vector<Pending> pending;
    const double weight = static_cast<double>(lights_.size()) / static_cast<double>(rounds);
    for (const Place& place : places) {
      const auto purpose = static_cast<std::uint32_t>(2 * round);
      std::size_t light = round;
      if (rounds < lights_.size()) {
        const double choice = random_point(tile, place, kLightChoice + purpose).x;
        light = std::min(static_cast<std::size_t>((static_cast<double>(round) + choice) * weight), lights_.size() - 1);
      }
      const auto lit = lights_.sample(light, place.position, place.normal,
                                      random_point(tile, place, kLightPoint + purpose));
      if (!lit) continue;
      rays.push_back(make_ray(place.position, lit->direction, kShadowReach * lit->distance));
      pending.push_back({place.pixel, weight / kPi * place.albedo * lit->irradiance});
    }
    const TraceResult traced = tracer_.any(rays);
    count(traced, rays.size(), result_.other_rays);
    for (std::size_t i = 0; i < pending.size(); ++i) {
      if (traced.occluded[i] == 0) sums_[pending[i].pixel] += pending[i].radiance;
    }
  }

  void count(const TraceResult& traced, std::size_t rays, std::uint64_t& counter) {
    counter += rays;
    result_.kernel_ms += traced.kernel_ms;
  }

  const Scene& scene_;
  RenderOptions options_;
  Tracer tracer_;
  std::optional<Tracer> counting_tracer_;
  Bounds bounds_;
  LightSet lights_;
  Sky sky_;
  CameraView view_;
  double diagonal_ = 1.0;
  std::vector<Point> sums_;  // of the tile's pixels
  RenderResult result_;
};

void require_range(const char* name, std::uint32_t value, std::uint32_t lowest, std::uint32_t highest) {
  if (value >= lowest && value <= highest) return;
  throw Error(ErrorCode::kInvalidArgument, std::string(name) + " is " + std::to_string(value) + "; it must be " +
                                               std::to_string(lowest) + " to " + std::to_string(highest));
}

}  // namespace

void RenderOptions::check() const {
  require_range("width", width, 1, 16384);
  require_range("height", height, 1, 16384);
  require_range("samples", samples, 1, 4096);
}

RenderResult render(const cl::Context& context, const DeviceBvh& tree, const Scene& scene,
                    const RenderOptions& options, const Progress& progress) {
  options.check();
  return Renderer(context, tree, scene, options).run(progress);
}

}  // namespace gnomon
