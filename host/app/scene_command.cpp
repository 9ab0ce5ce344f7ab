// gnomon scene: makes a scene and writes it as a file.
#include <memory>

#include "commands.h"
#include "document.h"
#include "gnomon/scene/generators.h"
#include "gnomon/scene/gltf_export.h"
#include "gnomon/scene/import.h"
#include "interrupt.h"
#include "scene_source.h"

namespace gnomon::app {
namespace {

struct Options {
  std::string name;
  bool list = false;
  std::uint64_t triangles = 0;
  bool triangles_given = false;
  std::uint64_t seed = 1;
  std::string file;
};

std::string generator_list() {
  Table table({"name", "default triangles", "fewest"});
  for (const GeneratorInfo& info : generators()) {
    table.add(
        {std::string(info.name), std::to_string(info.default_triangles), std::to_string(info.min_triangles)});
  }
  std::string out = table.text() + "\n";
  Facts facts;
  for (const GeneratorInfo& info : generators()) facts.add(std::string(info.name), std::string(info.summary));
  return out + facts.text();
}

int list(Console& console) {
  Json document = start_document("scene");
  document["generators"] = Json::array();
  for (const GeneratorInfo& info : generators()) {
    document["generators"].push_back({{"name", info.name},
                                      {"summary", info.summary},
                                      {"default_triangles", info.default_triangles},
                                      {"min_triangles", info.min_triangles}});
  }
  console.print(document);
  console.print(generator_list());
  return 0;
}

int run(const Options& options, Console& console) {
  if (options.list) return list(console);
  if (options.name.empty() || options.file.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "scene needs a NAME and -o FILE, or --list");
  }
  const std::uint64_t wanted = options.triangles_given ? options.triangles : default_triangles(options.name);
  const Scene scene = generate_scene(options.name, wanted, options.seed);
  stop_if_interrupted();
  write_glb(scene, options.file);
  const std::string hash = scene_hash(import_scene(options.file));  // of the file as readers will see it
  Json document = start_document("scene");
  add_device(document, nullptr);
  document["file"] = options.file;
  document["scene_name"] = scene.name;
  document["scene_hash"] = hash;
  document["triangles"] = scene.triangles.size();
  document["dropped"] = scene.report.dropped();
  document["options"] = {{"name", options.name}, {"triangles", wanted}, {"seed", options.seed}};
  console.print(document);
  console.print("wrote " + options.file + ": " + std::to_string(scene.triangles.size()) +
                " triangles, hash " + hash + "\n");
  return 0;
}

}  // namespace

void add_scene_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command = program.add_subcommand("scene", "Make a scene and write it as a .glb file.");
  command->add_option("name", options->name, "which scene, see --list")->type_name("NAME");
  command->add_flag("--list", options->list, "list the scenes that can be made");
  CLI::Option* const triangles = add_count(*command, "--triangles", options->triangles,
                                           "about so many triangles; 0: the scene's default");
  add_count(*command, "--seed", options->seed, "another seed, another scene of its kind");
  command->add_option("-o,--output", options->file, "the .glb file to write")->type_name("FILE");
  add_output_options(*command, output);
  command->footer(
      "The same name, count and seed give the same file on every machine.\n\n" + generator_list() +
      "\nExamples:\n  gnomon scene city --triangles 1M --seed 7 -o city.glb\n  gnomon scene --list");
  command->callback([&action, options, triangles] {
    options->triangles_given = triangles->count() > 0 && options->triangles > 0;
    action = [options](Console& console) { return run(*options, console); };
  });
}

}  // namespace gnomon::app
