// gnomon detect: where a scene's rays run together.
#include <cmath>
#include <memory>
#include <numbers>
#include <span>
#include <sstream>

#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "gnomon/areas/detect.h"
#include "gnomon/areas/detect_lights.h"
#include "gnomon/device/build_device.h"
#include "gnomon/scene/write_file.h"
#include "interrupt.h"
#include "numbers.h"
#include "ray_batch.h"
#include "scene_source.h"

namespace gnomon::app {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;
constexpr std::uint64_t kDrawnRays = 16384;

struct Options {
  SceneOptions scene;
  DeviceOptions device;
  std::vector<std::string> kinds{"primary", "bounce", "shadow"};
  RayFileOptions rays_in;
  std::uint64_t seed = 1;
  double least = 0.01;
  std::string out;
};

// What is known of one area, from a light or from rays.
struct Row {
  std::string what;  // "light 0 (sun)", "shadow rays"
  std::string kind;
  InfluenceArea area;
  Json facts;
};

std::string number(double value) {
  std::ostringstream out;
  out.precision(4);
  out << value;
  return out.str();
}

std::string place(const Vec3d& v) {
  return number(v[0]) + ", " + number(v[1]) + ", " + number(v[2]);
}

// As reproduce reads areas, and `up`, which it may leave out.
Json area_json(const InfluenceArea& area) {
  const AreaFrame& frame = area.frame();
  if (const auto* const box = std::get_if<OrientedBox>(&area.region())) {
    return {{"kind", "plane"},
            {"point", frame.origin},
            {"normal", frame.forward},
            {"up", frame.up},
            {"half_width", box->half[0]},
            {"half_height", box->half[1]},
            {"forward_size", 2.0 * box->half[2]}};
  }
  if (const auto* const frustum = std::get_if<Frustum>(&area.region())) {
    return {{"kind", "point"},
            {"eye", frame.origin},
            {"direction", frame.forward},
            {"up", frame.up},
            {"fov_x_deg", 2.0 * kDegrees * area.half_window()[0]},
            {"fov_y_deg", 2.0 * kDegrees * area.half_window()[1]},
            {"near", frustum->near_distance},
            {"far", frustum->far_distance}};
  }
  return {{"kind", "omni"}, {"centre", frame.origin}, {"radius", std::get<Ball>(area.region()).radius}};
}

std::string extent_words(const InfluenceArea& area) {
  if (const auto* const box = std::get_if<OrientedBox>(&area.region()))
    return number(2.0 * box->half[0]) + " x " + number(2.0 * box->half[1]) + " x " +
           number(2.0 * box->half[2]);
  if (const auto* const frustum = std::get_if<Frustum>(&area.region()))
    return fixed(2.0 * kDegrees * area.half_window()[0], 1) + " x " +
           fixed(2.0 * kDegrees * area.half_window()[1], 1) + " deg, " + number(frustum->near_distance) +
           " to " + number(frustum->far_distance);
  return "ball of " + number(std::get<Ball>(area.region()).radius);
}

Vec3d middle_of(const InfluenceArea& area) {
  const Box3d box = area.enclosing_box();
  return 0.5 * (box.lo + box.hi);
}

std::vector<NamedRays> rays_of(const Options& options, const Scene& scene, const Progress& progress) {
  if (!options.rays_in.file.empty()) return read_ray_file(options.rays_in);
  const cl::Context context = open_device(options.device);
  const DeviceBvh tree = build_device(context, scene.triangles, {}, nullptr, progress);
  const Tracer tracer(context, tree);
  std::vector<NamedRays> out;
  for (const std::string& kind : options.kinds)
    out.push_back(
        {kind, make_rays(*ray_kind_from(kind), scene, tracer, kDrawnRays, options.seed, progress), 0});
  return out;
}

Row row_of(const LightRegion& light, const Scene& scene) {
  const Light& own = scene.lights.at(light.light);
  Row row{"light " + std::to_string(light.light) + (own.name.empty() ? "" : " (" + own.name + ")"),
          kind_name(own.kind),
          light.region,
          {}};
  row.facts = {{"light", light.light},
               {"shrunk", light.shrunk},
               {"rays", light.count},
               {"coverage", light.coverage},
               {"inside", light.inside},
               {"spread_deg", kDegrees * light.spread},
               {"whole_area", area_json(light.area)}};
  return row;
}

Row row_of(const RayGroup& group, const std::string& rays) {
  Row row{rays + " rays", to_string(group.kind), group.area, {}};
  const bool bundle = group.kind == GroupKind::kBundle;
  row.facts = {{"of", rays},
               {"direction", group.direction},
               {"apex", bundle ? Json(nullptr) : Json(group.apex)},
               {"rays", group.count},
               {"coverage", group.coverage},
               {"inside", group.inside},
               {"spread_deg", kDegrees * group.spread},
               {"miss", bundle ? Json(nullptr) : Json(group.miss)},
               {"contrast", group.contrast},
               {"log10_chance", group.log10_chance}};
  return row;
}

std::string table_of(const std::vector<Row>& rows) {
  Table table({"rays", "kind", "middle", "apex or direction", "extent", "coverage", "spread deg", "chance"});
  for (const Row& row : rows) {
    const AreaFrame& frame = row.area.frame();
    const bool along = row.area.kind() == AreaKind::kPlane;
    table.add({row.what, row.kind, place(middle_of(row.area)),
               along ? "along " + place(frame.forward) : "at " + place(frame.origin), extent_words(row.area),
               fixed(100.0 * row.facts["coverage"].get<double>(), 1) + " %",
               number(row.facts["spread_deg"].get<double>()),
               row.facts.contains("log10_chance")
                   ? "1e" + std::to_string(std::lround(row.facts["log10_chance"].get<double>()))
                   : ""});
  }
  return table.text();
}

Json listed(const std::vector<Row>& rows) {
  Json out = Json::array();
  for (const Row& row : rows) {
    Json one{{"kind", row.kind}, {"area", area_json(row.area)}};
    one.update(row.facts);
    out.push_back(std::move(one));
  }
  return out;
}

// The list of areas for other programs: each by the fields that an area of reproduce's set-ups has.
void write_areas(const Options& options, const std::vector<Row>& rows) {
  Json configs = Json::array();
  for (const Row& row : rows) {
    Json one{{"scene", options.scene.source},
             {"area", row.area.kind() == AreaKind::kPlane ? "plane" : "point"},
             {"orientation", row.what + ", " + row.kind}};
    one.update(area_json(row.area));
    configs.push_back(std::move(one));
  }
  const std::string text = Json{{"configs", configs}}.dump(1) + "\n";
  write_file(options.out, std::as_bytes(std::span(text)));
}

int run(const Options& options, Console& console) {
  const Scene scene = load_scene(options.scene, console);
  const std::vector<NamedRays> rays = rays_of(options, scene, console.progress());
  stop_if_interrupted();
  DetectOptions settings;
  settings.seed = options.seed;
  settings.least_share = options.least;
  if (!scene.triangles.empty()) {
    const Bounds bounds = bounds_of(scene);
    settings.bounds =
        Box3d{{bounds.lo[0], bounds.lo[1], bounds.lo[2]}, {bounds.hi[0], bounds.hi[1], bounds.hi[2]}};
  }
  std::vector<Row> lights;
  std::vector<Row> groups;
  Json samples = Json::array();
  std::string seen;
  for (const NamedRays& some : rays) {
    try {
      if (some.kind == "shadow" || some.kind == "file") {
        for (const LightRegion& light : detect_lights(scene, some.rays)) {
          if (some.kind == "shadow" || light.shrunk) lights.push_back(row_of(light, scene));
        }
      }
      const Detection found = detect(some.rays, settings);
      for (const RayGroup& group : found.groups) groups.push_back(row_of(group, some.kind));
      samples.push_back({{"rays", some.kind},
                         {"count", found.rays},
                         {"looked_at", found.looked_at},
                         {"groups", found.groups.size()}});
      seen += some.kind + " rays: " + std::to_string(found.groups.size()) +
              (found.groups.size() == 1 ? " group in " : " groups in ") + std::to_string(found.looked_at) +
              " of " + std::to_string(found.rays) + "\n";
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kInvalidArgument || options.rays_in.file.empty()) throw;
      throw Error(ErrorCode::kBadScene, options.rays_in.file + ": " + error.what() +
                                            "; record them anew, or leave out this kind with --kinds");
    }
    stop_if_interrupted();
  }
  if (!options.out.empty()) {
    std::vector<Row> all = lights;
    all.insert(all.end(), groups.begin(), groups.end());
    write_areas(options, all);
  }
  Json document = start_document("detect");
  add_scene(document, options.scene, scene);
  const bool drawn = options.rays_in.file.empty();
  document["options"] = {{"rays", drawn ? Json(options.kinds) : Json(nullptr)},
                         {"rays_in", drawn ? Json(nullptr) : Json(options.rays_in.file)},
                         {"kinds", options.rays_in.kinds},
                         {"least", options.least},
                         {"seed", options.seed}};
  document["samples"] = std::move(samples);
  document["lights"] = listed(lights);
  document["groups"] = listed(groups);
  console.print(document);
  std::string text;
  if (!lights.empty())
    text += "Areas of the scene's lights, as far as their shadow rays go:\n" + table_of(lights) + "\n";
  text += groups.empty() ? "Nowhere do the rays run together more than chance has it.\n"
                         : "Found in the rays alone:\n" + table_of(groups);
  console.print(text + "\n" + seen);
  return 0;
}

}  // namespace

void add_detect_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("detect", "Find where rays run together: the areas that local trees are for.");
  add_scene_options(*command, options->scene);
  add_ray_kind_options(*command, options->kinds, options->rays_in);
  command
      ->add_option("--least", options->least, "the share of its kind's rays that a group must have, 0 to 1")
      ->check(CLI::Range(0.0, 1.0))
      ->type_name("S")
      ->capture_default_str();
  add_count(*command, "--seed", options->seed, "for the rays that are drawn at random");
  command
      ->add_option(
          "-o,--output", options->out,
          "write the areas to this file (JSON), by the fields that areas have in reproduce's set-ups")
      ->type_name("FILE");
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      "Kinds of groups:\n"
      "  bundle      parallel rays, as shadow rays to a sun; the area is a box along them\n"
      "  converging  towards a point, as shadow rays to a lamp; the area is a frustum or a ball about it\n"
      "  diverging   from a point, as a camera's\n"
      "Groups are found in the rays alone, each kind of rays by itself, so a lamp that is seen in a mirror "
      "has its own,\n"
      "at the place behind the mirror. Coverage is the share of the kind's rays in the group. Spread is the "
      "root mean\n"
      "square angle to the direction, or from a ray to the apex. Chance bounds the probability that rays "
      "without any\n"
      "direction had shown such a group; a group is reported from 1e-6 down, where it is five times as dense "
      "as what\n"
      "is around it. At most 8192 rays of a kind are looked at.\n"
      "\n" +
      explain_ray_kinds() +
      "\nExamples:\n  gnomon detect gen:city:100k --rays shadow\n"
      "  gnomon render model.glb -o picture.png --samples 64 --record rays.gnr && gnomon detect model.glb "
      "--rays-in rays.gnr\n"
      "  gnomon detect model.glb --rays-in rays.gnr --kinds shadow -o areas.json");
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
