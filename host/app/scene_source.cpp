#include "scene_source.h"

#include <algorithm>
#include <string>
#include <vector>

#include "gnomon/scene/generators.h"
#include "gnomon/scene/import.h"
#include "interrupt.h"
#include "numbers.h"

namespace gnomon::app {
namespace {

constexpr std::string_view kGenerated = "gen:";

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> parts;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(separator, at);
    parts.emplace_back(text.substr(at, end - at));
    if (end == std::string_view::npos) return parts;
    at = end + 1;
  }
}

std::uint64_t count_or_throw(const std::string& text, const std::string& source) {
  if (const auto count = parse_count(text)) return *count;
  throw Error(ErrorCode::kInvalidArgument,
              "\"" + text + "\" in " + source +
                  " is not a count; write gen:NAME[:TRIANGLES[:SEED]], as in gen:city:50k:7");
}

struct Generated {
  std::string name;
  std::uint64_t triangles = 0;
  std::uint64_t seed = 1;
};

Generated parse_generated(const std::string& source) {
  const auto parts = split(std::string_view(source).substr(kGenerated.size()), ':');
  if (parts.size() > 3)
    throw Error(ErrorCode::kInvalidArgument, source + ": write gen:NAME[:TRIANGLES[:SEED]]");
  const std::uint64_t triangles =
      parts.size() > 1 ? count_or_throw(parts[1], source) : default_triangles(parts.front());
  const std::uint64_t seed = parts.size() > 2 ? count_or_throw(parts[2], source) : 1;
  return {parts.front(), triangles, seed};
}

Scene generate(const std::string& source) {
  const Generated what = parse_generated(source);
  return generate_scene(what.name, what.triangles, what.seed);
}

Scene read(const SceneOptions& options) {
  ImportOptions import;
  import.invalid = options.policy();
  try {
    return import_scene(options.source, import);
  } catch (const Error& error) {
    // To whoever asked for this scene, a file that cannot be read is a scene that cannot be used.
    if (error.code() == ErrorCode::kIo) throw Error(ErrorCode::kBadScene, error.what());
    throw;
  }
}

}  // namespace

std::function<Scene(std::uint64_t)> at_sizes(const SceneOptions& options) {
  if (!options.source.starts_with(kGenerated)) return {};
  const Generated what = parse_generated(options.source);
  return [what](std::uint64_t triangles) { return generate_scene(what.name, triangles, what.seed); };
}

std::uint64_t default_triangles(std::string_view generator) {
  const auto known = generators();
  const auto found =
      std::find_if(known.begin(), known.end(), [&](const auto& info) { return info.name == generator; });
  return found == known.end() ? 1 : found->default_triangles;
}

Scene load_scene(const SceneOptions& options, Console& console) {
  const bool generated = options.source.starts_with(kGenerated);
  Scene scene = generated ? generate(options.source) : read(options);
  const ImportReport& report = scene.report;
  if (report.dropped() > 0) {
    console.note("dropped " + std::to_string(report.dropped()) + " triangles that cannot be traced: " +
                 std::to_string(report.non_finite_dropped) + " not finite or out of range, " +
                 std::to_string(report.zero_area_dropped) + " without area");
  }
  if (report.primitives_skipped > 0) {
    console.note("skipped " + std::to_string(report.primitives_skipped) + " points and lines");
  }
  for (const std::string& note : report.notes) console.note(note);
  stop_if_interrupted();
  return scene;
}

}  // namespace gnomon::app
