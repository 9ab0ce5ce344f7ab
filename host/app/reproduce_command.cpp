// gnomon reproduce: the thesis' tests run again, beside what it published.
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <memory>
#include <numbers>
#include <optional>
#include <sstream>

#include "commands.h"
#include "device_choice.h"
#include "document.h"
#include "gnomon/device/build_device.h"
#include "gnomon/tree/build_reference.h"
#include "interrupt.h"
#include "numbers.h"
#include "reproduce_rows.h"
#include "reproduce_text.h"
#include "scene_source.h"

namespace gnomon::app {
namespace {

struct Options {
  std::string configs, scenes, published, only, rows;
  ReproduceOptions reproduce;
  DeviceOptions device;
  bool on_device = false;
};

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

// A set-up is wanted when its label has every word of the pattern.
bool matches(const SetUp& set_up, const std::string& pattern) {
  const auto label = words_of(set_up.label());
  const auto wanted = words_of(pattern);
  return std::all_of(wanted.begin(), wanted.end(), [&](const std::string& word) {
    return std::find(label.begin(), label.end(), word) != label.end();
  });
}

std::vector<SetUp> wanted_set_ups(const Options& options, Console& console) {
  std::vector<SetUp> all = read_set_ups(options.configs);
  std::vector<SetUp> wanted;
  std::map<std::string, int> lost;
  for (SetUp& set_up : all) {
    if (!matches(set_up, options.only)) continue;
    if (is_lost(set_up.scene)) {
      ++lost[set_up.scene];
    } else {
      wanted.push_back(std::move(set_up));
    }
  }
  for (const auto& [scene, count] : lost) {
    console.note(scene + ": " + std::to_string(count) +
                 " set-ups skipped; the thesis' model of it was never published");
  }
  if (!wanted.empty()) return wanted;
  throw Error(ErrorCode::kInvalidArgument,
              lost.empty() ? "--only \"" + options.only +
                                 "\" matches no set-up; write words of scene, area and orientation, as in "
                                 "\"Suzanne plane 45\""
                           : "nothing is left to run");
}

class Reproduction {
 public:
  Reproduction(const Options& options, Console& console) : options_(options), console_(console) {
    if (options.on_device) context_.emplace(open_device(options.device));
    if (!options.published.empty()) published_ = read_published_results(options.published);
    if (options.rows.empty()) return;
    rows_.open(options.rows);
    if (!rows_) throw Error(ErrorCode::kIo, "cannot write " + options.rows + "; is its folder there?");
  }

  void run() {
    const std::vector<SetUp> set_ups = wanted_set_ups(options_, console_);
    for (std::size_t i = 0; i < set_ups.size(); ++i) {
      const SetUp& set_up = set_ups[i];
      const Progress progress = [&](std::string_view, double) {
        return console_.progress()(set_up.label(),
                                   static_cast<double>(i) / static_cast<double>(set_ups.size()));
      };
      report(progress, set_up.label(), 0.0);
      const ReproduceScene& scene = scene_of(set_up.scene);
      const SetUpReport result = run_set_up(set_up, scene, options_.reproduce, builder(), progress);
      stop_if_interrupted();
      summary_.add(set_up, result, published_);
      write(set_up, scene, result);
    }
    wide_frustum();
    if (rows_.is_open() && !rows_.flush()) throw Error(ErrorCode::kIo, "cannot write " + options_.rows);
  }

  [[nodiscard]] const Json& documents() const { return all_rows_; }
  [[nodiscard]] const ReproduceSummary& summary() const { return summary_; }
  [[nodiscard]] std::string table() const { return table_.text(); }
  [[nodiscard]] const cl::DeviceInfo* device() const { return context_ ? &context_->device() : nullptr; }
  [[nodiscard]] const std::vector<PredictionRun>& wide() const { return wide_; }

 private:
  [[nodiscard]] TreeBuilder builder() const {
    return [this](std::span<const GnTriangle> triangles, const BuildOptions& build) {
      if (!context_) return build_reference(triangles, build);
      return download_bvh(*context_, build_device(*context_, triangles, build));
    };
  }

  const ReproduceScene& scene_of(const std::string& name) {
    const auto known = scenes_.find(name);
    if (known != scenes_.end()) return known->second;
    SceneOptions source;
    source.source = scene_source_of(name);
    source.keep_flat = true;
    if (!source.source.starts_with("gen:")) source.source = options_.scenes + "/" + source.source;
    try {
      return scenes_.emplace(name, prepare_scene(load_scene(source, console_), builder())).first->second;
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kBadScene) throw;
      throw Error(ErrorCode::kBadScene, "scene " + name + ": " + error.what() +
                                            "\n--scenes names the folder of the thesis' models (suzanne.glb, "
                                            "cottage.glb, cottage-walls.glb, woods.glb)");
    }
  }

  const PublishedRow* published_of(const SetUp& set_up, const TreeRun& run) const {
    const auto row = published_.find(key_of(set_up, run.builder));
    return row == published_.end() ? nullptr : &row->second;
  }

  void write(const SetUp& set_up, const ReproduceScene& scene, const SetUpReport& result) {
    const Json start = row_start(set_up, scene, options_.reproduce);
    for (const TreeRun& run : result.trees) {
      const PublishedRow* const published = published_of(set_up, run);
      keep(tree_row(start, run, published, options_.reproduce));
      add_to_table(set_up, run, published);
    }
    for (const PredictionRun& run : result.predictions) keep(prediction_row(start, run, options_.reproduce));
  }

  void keep(const Json& row) {
    if (rows_.is_open()) rows_ << row.dump() << "\n";
    if (console_.json()) all_rows_.push_back(row);
  }

  void add_to_table(const SetUp& set_up, const TreeRun& run, const PublishedRow* published) {
    table_.add({set_up.label(), run.builder, run.heuristics, std::string(to_string(run.rays)),
                published == nullptr ? "" : fixed(published->local_cost, 1), fixed(run.local.mean, 1),
                published == nullptr ? "" : fixed(run.local.mean / published->local_cost, 3),
                published == nullptr || published->flag.empty() ? "" : "flagged",
                fixed(run.predicted_matching, 1), fixed(run.total.mean, 1), fixed(run.global.mean, 1),
                fixed(100.0 * run.local_hit_share, 0) + " %", fixed(run.closest.boxes, 1),
                fixed(run.any.boxes, 1)});
  }

  // 130 by 45 degrees, as wide as the areas of Crowd, on the cottage: where measures of rays differ most.
  void wide_frustum() {
    const auto cottage = scenes_.find("Cottage");
    if (cottage == scenes_.end()) return;
    constexpr double kDegree = std::numbers::pi / 180.0;
    PointView view;
    view.eye = {15.0, 2.7, 0.0};
    view.direction = {-1.0, 0.0, 0.0};
    view.fov_x = 130.0 * kDegree;
    view.fov_y = 45.0 * kDegree;
    view.near_distance = 1.0;
    view.far_distance = 35.0;
    const SetUp set_up{"Cottage", "point", "130x45", {}, InfluenceArea::point(view)};
    wide_ = check_predictions(set_up.area, cottage->second, options_.reproduce, builder());
    const Json start = row_start(set_up, cottage->second, options_.reproduce);
    for (const PredictionRun& run : wide_) keep(prediction_row(start, run, options_.reproduce));
  }

  const Options& options_;
  Console& console_;
  std::optional<cl::Context> context_;
  PublishedResults published_;
  std::ofstream rows_;
  std::map<std::string, ReproduceScene> scenes_;
  ReproduceSummary summary_;
  std::vector<PredictionRun> wide_;
  Json all_rows_ = Json::array();
  Table table_{{"set-up", "variant", "heuristics", "rays", "published", "measured", "ratio", "", "predicted",
                "total", "global", "hits", "closest boxes", "any boxes"}};
};

int run(const Options& options, Console& console) {
  Reproduction reproduction(options, console);
  reproduction.run();
  Json document = start_document("reproduce");
  add_device(document, reproduction.device());
  document["options"] = {{"only", options.only},
                         {"rays", options.reproduce.rays},
                         {"prediction_rays", options.reproduce.prediction_rays},
                         {"seed", options.reproduce.seed},
                         {"on_device", options.on_device}};
  document["summary"] = to_json(reproduction.summary());
  document["rows"] = reproduction.documents();
  console.print(document);
  console.print(reproduction.table() + "\n" + summary_text(reproduction.summary(), reproduction.wide()));
  return 0;
}

}  // namespace

void add_reproduce_command(CLI::App& program, OutputOptions& output, Action& action) {
  const auto options = std::make_shared<Options>();
  CLI::App* const command =
      program.add_subcommand("reproduce", "Run the thesis' tests again and compare with what it published.");
  command->add_option("--configs", options->configs, "the set-ups, a JSON file")
      ->required()
      ->type_name("FILE");
  command->add_option("--scenes", options->scenes, "the folder with the thesis' models as .glb files")
      ->required()
      ->type_name("DIR");
  command->add_option("--published", options->published, "the published results, a CSV file")
      ->type_name("FILE");
  command
      ->add_option("--only", options->only,
                   "run set-ups that have all these words of scene, area and orientation, as in \"Suzanne "
                   "plane 45\"")
      ->type_name("WORDS");
  add_count(*command, "--rays", options->reproduce.rays, "for each cost")->check(CLI::Range(1, 1000000000));
  add_count(*command, "--prediction-rays", options->reproduce.prediction_rays, "for the check of predictions")
      ->check(CLI::Range(1, 1000000000));
  add_count(*command, "--seed", options->reproduce.seed, "for the rays");
  command->add_option("--rows", options->rows, "write one JSON row a line here")->type_name("FILE");
  command->add_flag("--on-device", options->on_device, "build on the device; the trees are the same");
  add_device_options(*command, options->device);
  add_output_options(*command, output);
  command->footer(
      "Costs are the thesis': 2.0 for every inner node whose box the infinite ray pierces, 1.2 for every "
      "triangle of\n"
      "such a leaf; no order, no pruning. Variants are its builders with their faults (Full: PAH+SPFH, "
      "Facing: SAH+SPFH,\n"
      "Standard: SAH+LSPH, Longest: PAH+LSPH, for points what was really run), TrueLongest what was meant "
      "there.\n"
      "SAH3 and PAH3 try all three axes on every triangle that touches the area.\n\n"
      "Example:\n  gnomon reproduce --configs configs.json --scenes models --published results.csv --only "
      "\"Suzanne plane\"");
  command->callback(
      [&action, options] { action = [options](Console& console) { return run(*options, console); }; });
}

}  // namespace gnomon::app
