#include "gnomon/render/render.h"

#include <algorithm>
#include <array>
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
constexpr std::uint32_t kLights = 8;              // shadow rays from a place the camera sees, at most
constexpr double kOffset = 1e-5;                  // of shadow rays' origins, in diagonals, as in ray_set.h
constexpr double kShadowReach = 0.9999;           // of the distance to a light: its own surface does not hide it
constexpr double kOpenness = 0.03;                // diagonals at which a surface opposite dims ambient light by half

// What sample_point's numbers are for.
enum Purpose : std::uint32_t {
  kPixel,
  kAmbient,
  kBouncedChoice,
  kLightPoints,  // two for each light: which one, and where on it
  kBouncedPoints = kLightPoints + 2 * kLights,
};

// Where a ray hit, moved off the surface to the side it came from.
struct Place {
  Point position;
  Point normal;  // unit, on that side
  Point weight;  // by which light from here counts in the pixel: the surface's reflectance so far
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

// Progress of a part of the work as progress of the whole.
Progress part_of(const Progress& whole, double first, double last) {
  return [&whole, first, last](std::string_view stage, double done) {
    return !whole || whole(stage, first + (last - first) * done);
  };
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
      const auto share = [&](std::size_t tile) { return static_cast<double>(tile) / static_cast<double>(tiles.size()); };
      render_tile(tiles[i], part_of(progress, share(i), share(i + 1)));
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
    report(progress, "render", 0.0);
    const std::vector<Place> places = trace_camera(tile);
    add_all_lights(tile, places, part_of(progress, 0.1, 0.6));
    report(progress, "render", 0.6);
    const std::vector<Place> seen = add_ambient(tile, places);
    report(progress, "render", 0.8);
    add_one_light(tile, seen);
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

  // One ray a place, cosine-weighted: it sees the sky, or a surface whose own light is for the caller to add. What
  // bounced more often is a guess, dimmer where that surface is near (Zhukov et al. 1998, obscurances).
  [[nodiscard]] std::vector<Place> add_ambient(const Tile& tile, const std::vector<Place>& places) {
    std::vector<Ray> rays;
    rays.reserve(places.size());
    for (const Place& place : places) {
      const Point direction = cosine_direction(place.normal, random_point(tile, place, kAmbient));
      rays.push_back(make_ray(place.position, direction, std::numeric_limits<double>::infinity()));
    }
    const TraceResult traced = tracer_.closest(rays);
    count(traced, rays.size(), result_.other_rays);
    std::vector<Place> seen;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Hit& hit = traced.hits[i];
      if (hit.primitive == GN_NONE) {
        sums_[places[i].pixel] += places[i].weight * sky_.radiance(to_point(rays[i].direction));
        continue;
      }
      Place place = place_of(rays[i], hit, places[i].pixel, places[i].sample);
      place.weight *= places[i].weight;
      const double open = static_cast<double>(hit.t) / (static_cast<double>(hit.t) + kOpenness * diagonal_);
      sums_[place.pixel] += open * place.weight * sky_.bounced();
      seen.push_back(place);
    }
    return seen;
  }

  // A shadow ray from each place to each light, or to one of each share of them when there are many.
  void add_all_lights(const Tile& tile, const std::vector<Place>& places, const Progress& progress) {
    const std::size_t rounds = std::min<std::size_t>(kLights, lights_.size());
    const double share = static_cast<double>(lights_.size()) / static_cast<double>(rounds);
    for (std::uint32_t round = 0; round < rounds; ++round) {
      report(progress, "render", static_cast<double>(round) / static_cast<double>(rounds));
      for (const Place& place : places) {
        const std::size_t light = light_of_round(tile, place, round, rounds, kLightPoints);
        const auto lit = sample_light(tile, place, light, kLightPoints + 2 * round + 1);
        if (lit) queue(place, *lit, share);
      }
      trace_queue();
    }
  }

  // One shadow ray from each place, to the light that would give it most if it were free, by chance: each in
  // proportion (Talbot et al. 2005). Beyond some lights, a few drawn at random compete.
  void add_one_light(const Tile& tile, const std::vector<Place>& places) {
    const std::size_t rivals = std::min<std::size_t>(kLights, lights_.size());
    const double share = static_cast<double>(lights_.size()) / static_cast<double>(rivals);
    for (const Place& place : places) {
      const double draw = random_point(tile, place, kBouncedChoice).x;
      double sum = 0.0;
      std::array<std::optional<LightSample>, kLights> lit;
      for (std::uint32_t i = 0; i < rivals; ++i) {
        const std::size_t light = light_of_round(tile, place, i, rivals, kBouncedPoints);
        lit[i] = sample_light(tile, place, light, kBouncedPoints + 2 * i + 1);
        if (lit[i]) sum += luminance(lit[i]->irradiance);
      }
      double before = 0.0;
      for (std::uint32_t i = 0; i < rivals; ++i) {
        const double own = lit[i] ? luminance(lit[i]->irradiance) : 0.0;
        if (own > 0.0 && draw * sum < before + own) {
          queue(place, *lit[i], share * sum / own);
          break;
        }
        before += own;
      }
    }
    trace_queue();
  }

  [[nodiscard]] std::size_t light_of_round(const Tile& tile, const Place& place, std::uint32_t round,
                                           std::size_t rounds, std::uint32_t purpose) const {
    if (rounds == lights_.size()) return round;
    const double choice = random_point(tile, place, purpose + 2 * round).x + round;
    return std::min(static_cast<std::size_t>(choice * static_cast<double>(lights_.size()) / static_cast<double>(rounds)),
                    lights_.size() - 1);
  }

  [[nodiscard]] std::optional<LightSample> sample_light(const Tile& tile, const Place& place, std::size_t light,
                                                        std::uint32_t purpose) const {
    const Point2 point = lights_.is_area(light) ? random_point(tile, place, purpose) : Point2{0.0};
    return lights_.sample(light, place.position, place.normal, point);
  }

  // What waits for its shadow ray.
  void queue(const Place& place, const LightSample& lit, double factor) {
    queued_rays_.push_back(make_ray(place.position, lit.direction, kShadowReach * lit.distance));
    queued_.push_back({place.pixel, factor / kPi * place.weight * lit.irradiance});
  }

  void trace_queue() {
    const TraceResult traced = tracer_.any(queued_rays_);
    count(traced, queued_rays_.size(), result_.other_rays);
    for (std::size_t i = 0; i < queued_.size(); ++i) {
      if (traced.occluded[i] == 0) sums_[queued_[i].pixel] += queued_[i].radiance;
    }
    queued_rays_.clear();
    queued_.clear();
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
  std::vector<Ray> queued_rays_;
  std::vector<Pending> queued_;
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
