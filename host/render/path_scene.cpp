#include "gnomon/render/path_scene.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "gnomon/render/camera_view.h"
#include "gnomon/render/light_set.h"
#include "gnomon/render/render.h"
#include "gnomon/render/sky.h"
#include "gnomon/scene/steady_random.h"

namespace gnomon {
namespace {

constexpr double kOffset = 1e-5;     // of rays' origins off a surface, in diagonals, as in ray_set.h
constexpr double kRounding = 4e-7;   // and so much of the largest coordinate, which floats round by
constexpr double kNarrowest = 1e-3;  // difference of cosines over which a spot's edge fades

void copy(const Point& from, gn_f32* to) {
  for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(from[axis]);
}

bool shines(const Scene& scene, std::uint32_t triangle) {
  const Vec3& emission = scene.materials[scene.material_ids[triangle]].emission;
  return std::any_of(emission.begin(), emission.end(), [](float channel) { return channel > 0.0F; });
}

double area_of(const Triangle& t) {
  return 0.5 * glm::length(glm::cross(to_point(t.v1) - to_point(t.v0), to_point(t.v2) - to_point(t.v0)));
}

class Maker {
 public:
  Maker(const Scene& scene, const PathOptions& options) : scene_(scene), options_(options) {}

  PathScene make() {
    for (const Material& material : scene_.materials) add_surface(material);
    for (const Light& light : scene_.lights) add_light(light);
    const LightSet lights(scene_, bounds_of(scene_));
    if (out_.lights.empty() && !options_.sky) {
      out_.notes.push_back(lights.note());
      add_light(default_sun());
    }
    add_sky(lights.sky_level());
    fill_rows();
    std::sort(out_.links.begin(), out_.links.end(),
              [](const GnEmitterLink& a, const GnEmitterLink& b) { return a.triangle < b.triangle; });
    fill_frame();
    return std::move(out_);
  }

 private:
  void add_surface(const Material& material) {
    GnSurface surface{};
    copy(to_point(material.base_color), surface.base_color);
    copy(to_point(material.emission), surface.emission);
    surface.roughness = material.roughness;
    surface.metallic = material.metallic;
    out_.surfaces.push_back(surface);
  }

  void add_light(const Light& light) {
    GnPathLight out{};
    copy(to_point(light.position), out.position);
    copy(to_point(light.color), out.color);
    out.strength = static_cast<float>(luminance(to_point(light.color)));
    out.cos_outer = -2.0F;
    out.cone_scale = 1.0F;
    out.range = light.range;
    switch (light.kind) {
      case LightKind::kSpot: {
        const double outer = cos_turns(static_cast<double>(light.outer_cone) / (2.0 * kPi));
        const double inner = cos_turns(static_cast<double>(light.inner_cone) / (2.0 * kPi));
        out.cos_outer = static_cast<float>(outer);
        out.cone_scale = static_cast<float>(1.0 / std::max(kNarrowest, inner - outer));
        copy(glm::normalize(to_point(light.direction)), out.direction);
        break;
      }
      case LightKind::kPoint:
        break;
      case LightKind::kDirectional:
        out.kind = GN_LIGHT_SUN;
        copy(glm::normalize(to_point(light.direction)), out.direction);
        break;
      case LightKind::kArea:
        out.kind = GN_LIGHT_AREA;
        if (!add_emitters(light, out)) return;
        out.strength *= out.area;
    }
    out_.lights.push_back(out);
    out_.names.push_back(light.name);
  }

  // The triangles that shine and that no light before has claimed. False: there is none.
  bool add_emitters(const Light& light, GnPathLight& out) {
    out.first = static_cast<std::uint32_t>(out_.emitters.size());
    double area = 0.0;
    double reach = 0.0;
    for (const std::uint32_t triangle : light.triangles) {
      const Triangle& t = scene_.triangles[triangle];
      const double own = area_of(t);
      if (!(own > 0.0) || !shines(scene_, triangle) || !claimed_.insert(triangle).second) continue;
      area += own;
      for (const float* corner : {t.v0, t.v1, t.v2})
        reach = std::max(reach, glm::length(to_point(corner) - to_point(light.position)));
      out_.emitters.push_back({triangle, static_cast<float>(area)});
      out_.links.push_back({triangle, static_cast<std::uint32_t>(out_.lights.size())});
    }
    out.count = static_cast<std::uint32_t>(out_.emitters.size()) - out.first;
    if (out.count == 0) return false;
    out.area = out_.emitters.back().running_area;
    out.range = static_cast<float>(1.0001 * reach);
    return true;
  }

  void add_sky(double level) {
    const Sky sky(level);
    const Point up{0.0, 1.0, 0.0};
    const Point all = options_.sky ? to_point(*options_.sky) : Point{0.0};
    const Point horizon = options_.sky ? all : sky.radiance(Point{1.0, 0.0, 0.0});
    const Point zenith = options_.sky ? all : sky.radiance(up);
    copy(horizon, out_.frame.horizon);
    copy(zenith, out_.frame.zenith);
    copy(options_.sky ? all : sky.radiance(-up), out_.frame.ground);
    GnPathLight out{};
    out.kind = GN_LIGHT_SKY;
    out.strength = static_cast<float>(0.5 * kPi * luminance(horizon + zenith));
    out_.frame.sky_light = GN_NONE;
    if (!(out.strength > 0.0F)) return;
    out_.frame.sky_light = static_cast<std::uint32_t>(out_.lights.size());
    out_.lights.push_back(out);
    out_.names.emplace_back("sky");
  }

  void fill_rows() {
    const std::size_t stride = gn_light_stride(static_cast<gn_u32>(out_.lights.size()));
    out_.light_rows.assign(GN_LIGHT_ROWS * stride + GN_LIGHT_ROOM, 0.0F);
    const auto set = [&](std::size_t row, std::size_t light, float value) {
      out_.light_rows[row * stride + light] = value;
    };
    // Suns without strength.
    for (std::size_t i = out_.lights.size(); i < stride; ++i) set(GN_LIGHT_KINDS, i, GN_LIGHT_SUN);
    for (std::size_t i = 0; i < out_.lights.size(); ++i) {
      const GnPathLight& light = out_.lights[i];
      set(GN_LIGHT_KINDS, i, static_cast<float>(light.kind));
      set(GN_LIGHT_STRENGTHS, i, light.strength);
      set(GN_LIGHT_RANGES, i, light.range);
      set(GN_LIGHT_CONES, i, light.cos_outer);
      set(GN_LIGHT_CONE_SCALES, i, light.cone_scale);
      for (std::size_t k = 0; k < 3; ++k) {
        set(GN_LIGHT_POSITIONS + k, i, light.position[k]);
        set(GN_LIGHT_DIRECTIONS + k, i, light.direction[k]);
      }
    }
  }

  void fill_frame() {
    GnPathFrame& frame = out_.frame;
    if (scene_.cameras.empty())
      out_.notes.emplace_back("the scene has no camera: a default one sees all of it");
    const Camera camera = scene_.cameras.empty() ? default_camera(scene_) : scene_.cameras.front();
    const CameraView view(camera, options_.width, options_.height);
    copy(to_point(camera.position), frame.eye);
    copy(view.corner(), frame.corner);
    copy(view.right(), frame.right);
    copy(view.down(), frame.down);
    frame.width = options_.width;
    frame.height = options_.height;
    frame.tiles_across = (options_.width + 7) / 8;
    frame.light_count = static_cast<std::uint32_t>(out_.lights.size());
    frame.link_count = static_cast<std::uint32_t>(out_.links.size());
    frame.seed[0] = static_cast<std::uint32_t>(options_.seed);
    frame.seed[1] = static_cast<std::uint32_t>(options_.seed >> 32U);
    frame.strategy = static_cast<std::uint32_t>(options_.strategy);
    frame.first_roulette = options_.roulette_after;
    frame.offset = scene_.triangles.empty() ? 0.0F : offset_of(bounds_of(scene_));
  }

  static float offset_of(const Bounds& bounds) {
    double largest = 0.0;
    for (std::size_t axis = 0; axis < 3; ++axis)
      largest = std::max({largest, std::abs(static_cast<double>(bounds.lo[axis])),
                          std::abs(static_cast<double>(bounds.hi[axis]))});
    const double diagonal = glm::length(to_point(bounds.hi) - to_point(bounds.lo));
    return static_cast<float>(kOffset * diagonal + kRounding * largest);
  }

  const Scene& scene_;
  const PathOptions& options_;
  PathScene out_;
  std::set<std::uint32_t> claimed_;
};

}  // namespace

std::uint32_t PathScene::cells() const {
  return frame.tiles_across * ((frame.height + 7) / 8) * 64;
}

void PathOptions::check() const {
  RenderOptions size;
  size.width = width;
  size.height = height;
  size.check();
  if (max_bounces < 1 || max_bounces > 1024) {
    throw Error(ErrorCode::kInvalidArgument,
                "max_bounces is " + std::to_string(max_bounces) + "; it must be 1 to 1024");
  }
}

PathScene make_path_scene(const Scene& scene, const PathOptions& options) {
  options.check();
  return Maker(scene, options).make();
}

}  // namespace gnomon
