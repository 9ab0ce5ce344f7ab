#include "ray_batch.h"

#include <algorithm>

namespace gnomon::app {
namespace {

std::vector<NamedRays> read_record(const RayFileOptions& options) {
  std::vector<RecordedKind> kinds;
  for (const std::string& name : options.kinds) kinds.push_back(*recorded_kind_from(name));
  const RayRecord record = only_kinds(read_ray_record(options.file), kinds);
  std::vector<NamedRays> out;
  auto first = record.rays.begin();
  for (const RayStratum& stratum : record.strata) {
    const auto last = first + static_cast<std::ptrdiff_t>(stratum.stored);
    const std::string kind(to_string(stratum.kind));
    auto place =
        std::find_if(out.begin(), out.end(), [&](const NamedRays& some) { return some.kind == kind; });
    if (place == out.end()) place = out.insert(out.end(), {kind, {}, 0});
    place->traced += stratum.traced;
    place->rays.insert(place->rays.end(), first, last);
    first = last;
  }
  for (const std::string& wanted : options.kinds) {
    if (std::any_of(out.begin(), out.end(), [&](const NamedRays& some) { return some.kind == wanted; }))
      continue;
    throw Error(ErrorCode::kBadScene, options.file + " holds no " + wanted + " rays");
  }
  return out;
}

}  // namespace

CLI::Option* add_ray_file_options(CLI::App& command, RayFileOptions& options) {
  CLI::Option* const file =
      command
          .add_option("--rays-in", options.file,
                      "take the rays of this file instead: raw ones, or a record (.gnr) "
                      "as render --record writes")
          ->type_name("FILE");
  command
      .add_option("--kinds", options.kinds,
                  "of a record's rays only these, with commas between: camera, bounce, shadow, other")
      ->delimiter(',')
      ->check(CLI::IsMember({"camera", "bounce", "shadow", "other"}))
      ->needs(file)
      ->type_name("K,...");
  return file;
}

void add_ray_kind_options(CLI::App& command, std::vector<std::string>& kinds, RayFileOptions& file) {
  CLI::Option* const drawn = command.add_option("--rays", kinds, "which kinds of rays, with commas between")
                                 ->delimiter(',')
                                 ->check(CLI::IsMember(ray_kind_names()))
                                 ->type_name("KINDS")
                                 ->capture_default_str();
  add_ray_file_options(command, file)->excludes(drawn);
}

std::vector<NamedRays> read_ray_file(const RayFileOptions& options) {
  try {
    if (is_ray_record(options.file)) return read_record(options);
    std::vector<Ray> rays = read_rays(options.file);
    if (!options.kinds.empty()) {
      throw Error(ErrorCode::kInvalidArgument,
                  "--kinds chooses from a record (.gnr); " + options.file + " holds raw rays");
    }
    return {{"file", std::move(rays), 0}};
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kIo) throw Error(ErrorCode::kBadScene, error.what());
    throw;
  }
}

bool asks_shadow_only(const RayFileOptions& options) {
  return !options.kinds.empty() && std::all_of(options.kinds.begin(), options.kinds.end(),
                                               [](const std::string& kind) { return kind == "shadow"; });
}

std::vector<Ray> make_rays(RayKind kind, const Scene& scene, const Tracer& tracer, std::uint64_t count,
                           std::uint64_t seed, const Progress& progress) {
  if (kind == RayKind::kRandom) return random_rays(scene, count, seed);
  if (kind == RayKind::kParallel) return parallel_rays(scene, count, seed);
  std::vector<Ray> primary = primary_rays(scene, count, seed);
  if (kind == RayKind::kPrimary) return primary;
  const TraceResult traced = tracer.closest(primary, progress);
  return kind == RayKind::kBounce ? bounce_rays(scene, primary, traced.hits, count, seed)
                                  : shadow_rays(scene, primary, traced.hits, count, seed);
}

std::vector<std::string> ray_kind_names() {
  std::vector<std::string> names;
  for (const RayKind kind :
       {RayKind::kPrimary, RayKind::kBounce, RayKind::kShadow, RayKind::kRandom, RayKind::kParallel}) {
    names.emplace_back(to_string(kind));
  }
  return names;
}

std::string explain_ray_kinds() {
  return "Kinds of rays:\n"
         "  primary   from the scene's first camera through a picture\n"
         "  bounce    from where primary rays hit, into the hemisphere, cosine-weighted\n"
         "  shadow    from where primary rays hit to the lights (any hit)\n"
         "  random    from anywhere in the bounds to anywhere\n"
         "  parallel  all along the sun's direction, from outside (any hit)\n";
}

}  // namespace gnomon::app
