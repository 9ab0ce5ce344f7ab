// gnomon trace: sends a batch of rays through a tree and says how fast and how much work that was.
#include <memory>

#include "build_timing.h"
#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "gnomon/render/picture_tracing.h"
#include "heuristic_options.h"
#include "interrupt.h"
#include "numbers.h"
#include "plan_choice.h"
#include "plan_rays.h"
#include "planned_tracers.h"
#include "ray_batch.h"
#include "scene_source.h"
#include "trace_timing.h"
#include "tree_source.h"

namespace gnomon::app {
namespace {

struct Options {
  SceneOptions scene;
  DeviceOptions device;
  BuildOptions build;
  HeuristicOptions heuristic;
  std::string tree_file;  // empty: build one
  std::string kind = "primary";
  std::uint64_t count = 1'000'000;
  std::uint64_t seed = 1;
  std::string query;  // closest, any or empty: as the kind asks
  std::string flavour = "auto";
  std::string accuracy = "watertight";
  bool sort = false;
  std::string order = "given";
  std::uint64_t repeat = 5;
  RayFileOptions rays_in;
  std::string rays_out, hits_out;
  PlanRequest plan;
};

TraceFlavour flavour_from(const std::string& name) {
  for (const TraceFlavour flavour :
       {TraceFlavour::kThread, TraceFlavour::kWide, TraceFlavour::kPacket, TraceFlavour::kCompact})
    if (name == to_string(flavour)) return flavour;
  return TraceFlavour::kAuto;
}

TraceOptions how_to_trace(const Options& options, const Scene& scene) {
  TraceOptions how;
  how.flavour = flavour_from(options.flavour);
  how.accuracy = options.accuracy == "fast" ? Accuracy::kFast : Accuracy::kWatertight;
  how.sort_rays = options.order != "given";
  if (options.order == "light") how.lights = ray_lights_of(scene);
  return how;
}

Json cost_of_fast(const HitDifference& cost) {
  return {{"lost", cost.lost},
          {"added", cost.added},
          {"other_triangle", cost.other_triangle},
          {"max_t_ulp", cost.max_t_ulp}};
}

// Whether to ask for any hit only. Files hold closest hits, so writing one asks for those.
bool wants_any_hit(const Options& options) {
  if (options.query == "any" && !options.hits_out.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "--hits-out writes closest hits: leave out --query any");
  }
  if (!options.query.empty()) return options.query == "any";
  if (!options.hits_out.empty()) return false;
  if (!options.rays_in.file.empty()) return asks_shadow_only(options.rays_in);
  return asks_any_hit(*ray_kind_from(options.kind));
}

std::vector<Ray> rays_of(const Options& options, const Scene& scene, const cl::Context& context,
                         const DeviceBvh& tree, const Progress& progress) {
  if (options.rays_in.file.empty()) {
    return make_rays(*ray_kind_from(options.kind), scene, Tracer(context, tree), options.count, options.seed,
                     progress);
  }
  std::vector<Ray> rays;
  for (const NamedRays& some : read_ray_file(options.rays_in))
    rays.insert(rays.end(), some.rays.begin(), some.rays.end());
  return rays;
}

void add_trace(Json& document, const Options& options, const TimedTrace& trace, std::size_t rays,
               bool any_hit) {
  Json& chosen = document["options"];
  const bool made = options.rays_in.file.empty();
  chosen["rays"] = made ? Json(options.kind) : Json(nullptr);
  chosen["rays_in"] = made ? Json(nullptr) : Json(options.rays_in.file);
  chosen["kinds"] = options.rays_in.kinds;
  chosen["count"] = options.count;
  chosen["seed"] = options.seed;
  chosen["query"] = any_hit ? "any" : "closest";
  chosen["repeat"] = options.repeat;
  chosen["flavour"] = options.flavour;
  chosen["accuracy"] = options.accuracy;
  chosen["sort"] = options.order != "given";
  chosen["order"] = options.order;
  document["flavour"] = to_string(trace.flavour);
  document["cost_of_fast"] = trace.cost ? cost_of_fast(*trace.cost) : Json(nullptr);
  document["rays"] = rays;
  document["hits"] = trace.hit_count;
  document["invalid_rays"] = trace.invalid_rays;
  document["mrays_per_s"] = to_json(trace.mrays_per_s);
  document["clock"] = trace.device_clock ? "device" : "wall";
  document["seconds"] = trace.seconds;
  document["wall_seconds"] = trace.wall_seconds;
  document["boxes_per_ray"] = trace.boxes_per_ray;
  document["triangles_per_ray"] = trace.triangles_per_ray;
}

std::string facts_of(const Options& options, const cl::DeviceInfo& device, const Scene& scene,
                     const std::string& heuristic, const TimedBuild& build, const std::string& plan,
                     const TimedTrace& trace, std::size_t rays, bool any_hit) {
  const double share =
      rays == 0 ? 0.0 : 100.0 * static_cast<double>(trace.hit_count) / static_cast<double>(rays);
  Facts facts;
  facts.add("device", describe(device));
  facts.add("scene", describe(scene));
  facts.add("heuristic", heuristic);
  facts.add("plan", plan);
  facts.add("tree", describe(build));
  facts.add("rays", std::to_string(rays) + " " +
                        (options.rays_in.file.empty() ? options.kind : "from " + options.rays_in.file) +
                        ", " + (any_hit ? "any hit" : "closest hit"));
  facts.add("hits", std::to_string(trace.hit_count) + " (" + fixed(share, 1) + " %)");
  if (trace.invalid_rays > 0)
    facts.add("invalid", std::to_string(trace.invalid_rays) + " rays that miss for that");
  facts.add("speed", fixed(trace.mrays_per_s.median, 3) + " Mrays/s (median of " +
                         std::to_string(trace.mrays_per_s.count) + ", " + fixed(trace.mrays_per_s.min, 3) +
                         " to " + fixed(trace.mrays_per_s.max, 3) + "; " +
                         (trace.device_clock ? "device time)" : "wall clock, transfers included)"));
  facts.add("flavour", std::string(to_string(trace.flavour)) +
                           (options.order == "given" ? "" : ", rays sorted first, by " + options.order));
  if (trace.cost) {
    facts.add("fast costs",
              std::to_string(trace.cost->lost) + " hits lost, " + std::to_string(trace.cost->added) +
                  " added, " + std::to_string(trace.cost->other_triangle) +
                  " of another triangle; t off by up to " + fixed(trace.cost->max_t_ulp, 0) + " ulp");
  }
  facts.add("work", fixed(trace.boxes_per_ray, 2) + " boxes and " + fixed(trace.triangles_per_ray, 2) +
                        " triangles tested a ray");
  return facts.text();
}

// A learnt order is an order of slots, which the binary tree has not.
void check_plan(const Options& options) {
  options.plan.check();
  if (!options.plan.asked || options.flavour != "thread") return;
  if (options.plan.name == "sah" || options.plan.name == "best") return;
  throw Error(
      ErrorCode::kInvalidArgument,
      "--flavour thread looks at the nearer child first whatever was learnt; use wide, packet, compact or "
      "auto with --plan " +
          options.plan.name);
}

// How often this run traces its rays: to warm up, timed, counted.
std::uint64_t passes(const Options& options) {
  return options.repeat + 2;
}

PlanTask plan_task(const Options& options, const cl::Context& context, const Scene& scene,
                   const TimedBuild& build, std::span<const Ray> rays, bool any_hit,
                   const Progress& progress) {
  const bool told = options.plan.expected != 0;
  const double expected = static_cast<double>(told ? options.plan.expected : rays.size() * passes(options));
  const Query query = any_hit ? Query::kAny : Query::kClosest;
  const auto draw = [&options, &context, &scene, &build, rays, query, expected, progress] {
    PlanRays asked = options.rays_in.file.empty()
                         ? rays_to_plan_for(*ray_kind_from(options.kind), scene, context, build.tree,
                                            expected, options.seed, progress)
                         : rays_to_plan_for(options.rays_in.file, query, rays, expected);
    asked.query = query;
    return std::vector<PlanRays>{std::move(asked)};
  };
  const std::string counted =
      told ? "" : std::to_string(rays.size()) + " in each of " + std::to_string(passes(options)) + " passes";
  return {context,
          scene,
          build,
          {{query, rays, expected}},
          counted,
          draw,
          TreesWanted::kOneEach,
          traces_wide(context.device(), flavour_from(options.flavour)),
          takes_packets(context.device(), flavour_from(options.flavour))};
}

int run(const Options& options, Console& console) {
  options.build.check();
  check(options.heuristic);
  check_plan(options);
  const bool any_hit = wants_any_hit(options);
  const cl::Context context = open_device(options.device);
  const Scene scene = load_scene(options.scene, console);
  TimedBuild build =
      tree_for_use(context, scene, options.tree_file, with_heuristic(options.build, options.heuristic, scene),
                   {1, true}, console.progress());
  const std::vector<Ray> rays = rays_of(options, scene, context, build.tree, console.progress());
  stop_if_interrupted();
  const PlanTask task = plan_task(options, context, scene, build, rays, any_hit, console.progress());
  const PlanOutcome planned = plan_for(options.plan, task, console.progress());
  stop_if_interrupted();
  std::unique_ptr<DeviceWideBvh> wide;
  if (const PlanTree* const kept = planned.tree(0)) {
    adopt(build, task, *kept);
    wide = wide_form(context, scene, build.tree, *kept, flavour_from(options.flavour));
  }
  const TimedTrace trace = trace_timed(context, build.tree, rays, any_hit, how_to_trace(options, scene),
                                       options.repeat, console.progress(), wide.get());
  stop_if_interrupted();
  if (!options.rays_out.empty()) write_rays(options.rays_out, rays);
  if (!options.hits_out.empty()) write_hits(options.hits_out, trace.hits);
  const BuildOptions& tree = build.options;
  Json document = start_document("trace");
  add_device(document, &context.device());
  add_scene(document, options.scene, scene);
  add_tree_options(document, context.device(), scene.triangles.size(), tree);
  add_heuristic(document, options.heuristic, scene);
  add_build(document, build);
  add_tree_file(document, build);
  add_trace(document, options, trace, rays.size(), any_hit);
  add_plan(document, planned);
  console.print(document);
  console.print(facts_of(options, context.device(), scene, describe(options.heuristic, tree, scene), build,
                         describe(planned), trace, rays.size(), any_hit));
  return 0;
}

const char* const kFiles =
    "Files hold raw little-endian records and nothing else, where they are not records of a render:\n"
    "  a ray, 32 bytes: origin x y z, tmin, direction x y z, tmax, all float32\n"
    "  a hit, 16 bytes: t, u, v as float32, triangle as uint32; a miss has triangle 0xffffffff and t "
    "infinite\n"
    "A record (.gnr) has a header and says which rays are of which kind; README describes it.\n"
    "The hit of a ray has the ray's place. The point hit is origin + t * direction = (1-u-v) v0 + u v1 + v "
    "v2.\n";

const char* const kFigures =
    "Speed is of a timed pass: by the device's clock, or by the wall clock and with transfers where it has "
    "none.\nWork is boxes and triangles tested a ray, counted in a pass of its own; what a packet of rays "
    "tests "
    "for all of\nthem counts once.\n";

}  // namespace

void add_trace_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand("trace", "Trace rays through a scene's tree and time it.");
  add_scene_options(*command, options->scene);
  CLI::Option* const kind = command->add_option("--rays", options->kind, "which kind of rays to make")
                                ->check(CLI::IsMember(ray_kind_names()))
                                ->type_name("KIND")
                                ->capture_default_str();
  add_count(*command, "--count", options->count, "so many rays; bounce and shadow rays: at most");
  add_count(*command, "--seed", options->seed, "for the rays that are drawn at random");
  add_ray_file_options(*command, options->rays_in)->excludes(kind);
  command->add_option("--rays-out", options->rays_out, "write the rays traced")->type_name("FILE");
  command->add_option("--hits-out", options->hits_out, "write the closest hits")->type_name("FILE");
  command
      ->add_option(
          "--query", options->query,
          "closest or any; default: any for shadow and parallel, else closest (a file's rays: any where "
          "--kinds names shadow alone)")
      ->check(CLI::IsMember({"closest", "any"}))
      ->type_name("Q");
  command
      ->add_option(
          "--flavour", options->flavour,
          "thread: the binary tree; wide: eight boxes at a time; packet: wide, and rays that run together "
          "as one; compact: less memory, for GPUs; auto: as suits the device, on CPUs packets where they "
          "pay. Hits are the same, boxes a ray are not")
      ->check(CLI::IsMember({"auto", "thread", "wide", "packet", "compact"}))
      ->type_name("F")
      ->capture_default_str();
  command
      ->add_option("--accuracy", options->accuracy,
                   "watertight: every hit is decided exactly; fast: by floats alone, about a tenth faster on "
                   "CPUs, and "
                   "says which hits that cost")
      ->check(CLI::IsMember({"watertight", "fast"}))
      ->type_name("A")
      ->capture_default_str();
  CLI::Option* const order =
      command
          ->add_option("--order", options->order,
                       "sort rays before tracing them, inside the time; hits stay in their order. origin: by "
                       "where they start, which pays for rays in no order, such as bounces from all over the "
                       "picture. light: for any hit, by which of the scene's points and suns they go to, and "
                       "where to neighbours run, so that packets can take them; for closest hits as origin")
          ->check(CLI::IsMember({"given", "origin", "light"}))
          ->type_name("O")
          ->capture_default_str();
  command->add_flag("--sort", options->sort, "as --order origin")->excludes(order);
  add_count(*command, "--repeat", options->repeat, "timed passes, after one to warm up")
      ->check(CLI::Range(1, 10000));
  add_build_options(*command, options->build);
  add_heuristic_options(*command, options->heuristic);
  add_tree_file_option(*command, options->tree_file);
  add_plan_options(*command, options->plan,
                   "rays to come, that a tree must repay itself over; default: those that this run traces, "
                   "--count in each of --repeat and two more passes (to warm up, and to count work)");
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(explain_ray_kinds() + "\n" + kFiles + "\n" + kFigures + explain_plans() +
                  "\nExamples:\n  gnomon trace model.glb --rays bounce --count 2M\n"
                  "  gnomon trace model.glb --rays-in my.rays --hits-out my.hits\n"
                  "  gnomon build model.glb -o model.gnb && gnomon trace model.glb --tree model.gnb\n"
                  "  gnomon trace model.glb --rays-in rays.gnr --kinds shadow");
  command->callback([&action, options, command] {
    settle(*command, options->plan);
    if (options->sort) options->order = "origin";
    action = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace gnomon::app
