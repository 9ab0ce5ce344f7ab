#include "gnomon/render/render.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "gnomon/render/camera_view.h"
#include "gnomon/render/film.h"
#include "gnomon/render/light_rays.h"
#include "gnomon/render/sky.h"

namespace gnomon {
namespace {

constexpr std::uint32_t kTileRays = 1U << 18U;  // camera rays traced at a time
constexpr double kOffset = 1e-5;    // of rays' origins off a surface, in diagonals, as in ray_set.h
constexpr double kOpenness = 0.03;  // diagonals at which a surface opposite halves what bounced often

struct Tile {
  std::uint32_t x, y, width, height;
};

// Progress of a part of the work as progress of the whole.
Progress part_of(const Progress& whole, double first, double last) {
  return [&whole, first, last](std::string_view stage, double done) {
    return !whole || whole(stage, first + (last - first) * done);
  };
}

class Renderer {
 public:
  Renderer(const cl::Context& context, const DeviceBvh& tree, const Scene& scene,
           const RenderOptions& options)
      : scene_(scene),
        options_(options),
        tracer_(context, tree),
        lights_(scene, bounds_of(scene)),
        light_rays_(lights_, options.seed),
        sky_(lights_.sky_level()),
        camera_(scene.cameras.empty() ? default_camera(scene) : scene.cameras.front()),
        view_(camera_, options.width, options.height),
        film_(options.width, options.height) {
    if (options.heat_map) {
      TraceOptions counting;
      counting.counters = true;
      counting_tracer_.emplace(context, tree, counting);
      result_.boxes.resize(film_.pixels.size());
    }
    const Bounds bounds = bounds_of(scene);
    if (!scene.triangles.empty()) diagonal_ = glm::length(to_point(bounds.hi) - to_point(bounds.lo));
    if (!lights_.note().empty()) result_.notes.push_back(lights_.note());
    if (scene.cameras.empty())
      result_.notes.emplace_back("the scene has no camera: a default one sees all of it");
  }

  RenderResult run(const Progress& progress) {
    const std::vector<Tile> tiles = cut_tiles();
    const auto share = [&](std::size_t tile) {
      return static_cast<double>(tile) / static_cast<double>(tiles.size());
    };
    for (std::size_t i = 0; i < tiles.size(); ++i)
      render_tile(tiles[i], part_of(progress, share(i), share(i + 1)));
    result_.picture = develop(film_, options_.samples, progress);
    for (const FilmPixel& pixel : film_.pixels) {
      result_.coverage.push_back(pixel.hits / static_cast<float>(options_.samples));
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

  void render_tile(const Tile& tile, const Progress& progress) {
    report(progress, "render", 0.0);
    const std::vector<Place> places = trace_camera(tile);
    const std::uint32_t rounds = light_rays_.rounds();
    for (std::uint32_t round = 0; round < rounds; ++round) {
      report(progress, "render", 0.1 + 0.5 * round / rounds);
      add_unless_hidden(light_rays_.aim_round(places, round), &FilmPixel::direct);
    }
    report(progress, "render", 0.6);
    const std::vector<Place> opposite = trace_ambient(places);
    report(progress, "render", 0.8);
    add_unless_hidden(light_rays_.aim_once(opposite), &FilmPixel::soft);
  }

  // The places the camera sees; sky and glowing surfaces are entered at once.
  [[nodiscard]] std::vector<Place> trace_camera(const Tile& tile) {
    std::vector<Ray> rays;
    std::vector<std::uint32_t> pixels;
    for (std::uint32_t y = tile.y; y < tile.y + tile.height; ++y) {
      for (std::uint32_t x = tile.x; x < tile.x + tile.width; ++x) {
        pixels.push_back(y * options_.width + x);
        for (std::uint32_t sample = 0; sample < options_.samples; ++sample) {
          const Point2 at = sample_point(options_.seed, pixels.back(), kWithinPixel, sample);
          rays.push_back(view_.ray(x + at.x, y + at.y));
        }
      }
    }
    const TraceResult traced = (counting_tracer_ ? *counting_tracer_ : tracer_).closest(rays);
    count(traced, rays.size(), result_.camera_rays);
    std::vector<Place> places;
    for (std::uint32_t i = 0; i < rays.size(); ++i) {
      const std::uint32_t pixel = pixels[i / options_.samples];
      if (!traced.counters.empty()) {
        result_.boxes[pixel] +=
            static_cast<float>(traced.counters[i].boxes) / static_cast<float>(options_.samples);
      }
      if (traced.hits[i].primitive == GN_NONE) {
        film_.pixels[pixel].direct += glm::vec3(sky_.radiance(to_point(rays[i].direction)));
        continue;
      }
      places.push_back(place_of(rays[i], traced.hits[i], pixel, i % options_.samples));
      enter(places.back(), material_of(traced.hits[i]));
    }
    return places;
  }

  void enter(const Place& place, const Material& material) {
    FilmPixel& pixel = film_.pixels[place.pixel];
    pixel.direct += glm::vec3(to_point(material.emission));
    pixel.albedo += glm::vec3(place.albedo);
    pixel.normal += glm::vec3(place.normal);
    pixel.position += glm::vec3(place.position - to_point(camera_.position));
    pixel.hits += 1.0F;
  }

  [[nodiscard]] const Material& material_of(const Hit& hit) const {
    return scene_.materials[scene_.material_ids[hit.primitive]];
  }

  [[nodiscard]] Place place_of(const Ray& ray, const Hit& hit, std::uint32_t pixel,
                               std::uint32_t sample) const {
    const Triangle& t = scene_.triangles[hit.primitive];
    const Point v0 = to_point(t.v0);
    const Point e1 = to_point(t.v1) - v0;
    const Point e2 = to_point(t.v2) - v0;
    Point normal = glm::cross(e1, e2);
    const double length = glm::length(normal);
    normal = length > 0.0 ? normal / length : -to_point(ray.direction);
    if (glm::dot(normal, to_point(ray.direction)) > 0.0) normal = -normal;
    const Point surface = v0 + static_cast<double>(hit.u) * e1 + static_cast<double>(hit.v) * e2;
    return {surface + kOffset * diagonal_ * normal, normal, to_point(material_of(hit).base_color), pixel,
            sample};
  }

  // One ray a place, cosine-weighted: into the sky, or to a place opposite, which is returned. What reaches
  // that one after more bounces is a guess, less where it is near (Zhukov et al. 1998, obscurances).
  [[nodiscard]] std::vector<Place> trace_ambient(const std::vector<Place>& places) {
    std::vector<Ray> rays;
    rays.reserve(places.size());
    for (const Place& place : places) {
      const Point direction = cosine_direction(place.normal, place.random(options_.seed, kAmbientDirection));
      rays.push_back(make_ray(place.position, direction, std::numeric_limits<double>::infinity()));
    }
    const TraceResult traced = tracer_.closest(rays);
    count(traced, rays.size(), result_.other_rays);
    std::vector<Place> opposite;
    for (std::size_t i = 0; i < places.size(); ++i) {
      const Hit& hit = traced.hits[i];
      glm::vec3& soft = film_.pixels[places[i].pixel].soft;
      if (hit.primitive == GN_NONE) {
        soft += glm::vec3(sky_.radiance(to_point(rays[i].direction)));
        continue;
      }
      opposite.push_back(place_of(rays[i], hit, places[i].pixel, places[i].sample));
      const double open = static_cast<double>(hit.t) / (static_cast<double>(hit.t) + kOpenness * diagonal_);
      soft += glm::vec3(open * opposite.back().albedo * sky_.bounced());
    }
    return opposite;
  }

  void add_unless_hidden(const ShadowBatch& batch, glm::vec3 FilmPixel::*part) {
    const TraceResult traced = tracer_.any(batch.rays);
    count(traced, batch.rays.size(), result_.other_rays);
    for (std::size_t i = 0; i < batch.pending.size(); ++i) {
      const Pending& light = batch.pending[i];
      if (traced.occluded[i] == 0) film_.pixels[light.pixel].*part += glm::vec3(light.radiance);
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
  LightSet lights_;
  LightRays light_rays_;
  Sky sky_;
  Camera camera_;
  CameraView view_;
  Film film_;
  double diagonal_ = 1.0;
  RenderResult result_;
};

void require_range(const char* name, std::uint64_t value, std::uint64_t lowest, std::uint64_t highest) {
  if (value >= lowest && value <= highest) return;
  throw Error(ErrorCode::kInvalidArgument, std::string(name) + " is " + std::to_string(value) +
                                               "; it must be " + std::to_string(lowest) + " to " +
                                               std::to_string(highest));
}

}  // namespace

void RenderOptions::check() const {
  require_range("width", width, 1, 16384);
  require_range("height", height, 1, 16384);
  require_range("width times height", std::uint64_t{width} * height, 1, 1ULL << 26);
  require_range("samples", samples, 1, 4096);
}

RenderResult render(const cl::Context& context, const DeviceBvh& tree, const Scene& scene,
                    const RenderOptions& options, const Progress& progress) {
  options.check();
  return Renderer(context, tree, scene, options).run(progress);
}

}  // namespace gnomon
