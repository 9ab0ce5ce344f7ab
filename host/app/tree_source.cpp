#include "tree_source.h"

#include <utility>

#include "options.h"

namespace gnomon::app {
namespace {

TimedBuild from_file(const cl::Context& context, const Scene& scene, const std::string& file) {
  StoredTree stored = load_tree_of(scene, file);
  TimedBuild result;
  result.file = file;
  result.options = stored.options;
  result.fitted = stored.fitted;
  result.host = std::move(stored.bvh);
  result.tree = upload_bvh(context, result.host, scene.triangles);
  result.hash = tree_hash(result.host);
  result.stats = stats_of(result.host, result.options);
  return result;
}

}  // namespace

void add_tree_file_option(CLI::App& command, std::string& file) {
  CLI::Option* const option =
      command
          .add_option("--tree", file,
                      "take the tree from this file, which gnomon build -o wrote for the same scene")
          ->type_name("FILE.gnb")
          ->group(kTreeGroup);
  for (CLI::Option* const other : command.get_options()) {
    if (other != option && (other->get_group() == kTreeGroup || other->get_group() == kRaysGroup))
      option->excludes(other);
  }
}

StoredTree load_tree_of(const Scene& scene, const std::string& file) {
  try {
    return load_tree(file, scene.triangles);
  } catch (const Error& error) {
    if (error.code() == ErrorCode::kIo) throw Error(ErrorCode::kBadScene, error.what());
    throw;
  }
}

TimedBuild tree_for_use(const cl::Context& context, const Scene& scene, const std::string& file,
                        const BuildOptions& options, const BuildRuns& runs, const Progress& progress) {
  if (!file.empty()) return from_file(context, scene, file);
  return build_for_use(context, scene, options, runs, progress);
}

TimedBuild tree_timed(const cl::Context& context, const Scene& scene, const std::string& file,
                      const BuildOptions& options, const BuildRuns& runs, const Progress& progress) {
  if (!file.empty()) return from_file(context, scene, file);
  return build_timed(context, scene, options, runs, progress);
}

void add_tree_file(Json& document, const TimedBuild& build) {
  document["tree_file"] = build.file.empty() ? Json(nullptr) : Json(build.file);
  if (build.file.empty()) return;
  document["build"] = nullptr;
  document["options"]["axes"] = to_string(build.options.axes);
}

}  // namespace gnomon::app
