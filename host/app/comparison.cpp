#include "comparison.h"

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <memory>

#include "device_builder.h"
#include "device_choice.h"
#include "document.h"
#include "embree_methods.h"
#include "exit_status.h"
#include "gnomon/compare/across.h"
#include "gnomon/compare/analysis.h"
#include "gnomon/scene/write_file.h"
#include "numbers.h"
#include "report_files.h"
#include "version.h"

namespace gnomon::app {
namespace {

namespace fs = std::filesystem;

// "90", "90s", "1.5m", "2h" in seconds.
double seconds_from(const std::string& text) {
  std::string number = text;
  double unit = 1.0;
  if (!number.empty()) {
    const char last = number.back();
    unit = last == 'm' ? 60.0 : last == 'h' ? 3600.0 : 1.0;
    if (last == 's' || last == 'm' || last == 'h') number.pop_back();
  }
  const auto value = parse_numbers(number);
  if (!value || value->size() != 1 || !(value->front() > 0.0) || value->front() > 1e6)
    throw Error(ErrorCode::kInvalidArgument, "--time " + text + ": write 60s, 2m or 1h");
  return value->front() * unit;
}

// As a shell takes it.
std::string quoted(const std::string& word) {
  if (!word.empty() &&
      word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@") ==
          std::string::npos)
    return word;
  std::string out = "'";
  for (const char c : word) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

std::string joined(const std::vector<std::string>& words) {
  std::string out;
  for (const std::string& word : words) out += (out.empty() ? "" : ",") + word;
  return out;
}

// With what decides the rows spelt out, and nothing that does not.
std::string command_of(const CompareOptions& options) {
  std::string out =
      "gnomon compare " + quoted(options.scene.source) + " --rays " + quoted(joined(options.kinds));
  if (!options.methods.empty()) out += " --methods " + quoted(joined(options.methods));
  if (!options.devices.empty()) out += " --devices " + quoted(joined(options.devices));
  out += " --ray-count " + std::to_string(options.run.ray_count) + " --judged-rays " +
         std::to_string(options.run.judged_rays) + " --rounds " + std::to_string(options.run.rounds) +
         " --seed " + std::to_string(options.run.seed) + " --time " + quoted(options.time) + " --clock " +
         options.clock;
  if (options.scene.invalid != "drop") out += " --invalid " + options.scene.invalid;
  return out + " -o " + quoted(options.page);
}

compare::Report start_report(const CompareOptions& options, const Scene& scene) {
  compare::Report report;
  report.version = version();
  report.commit = commit();
  report.command = command_of(options);
  report.scene = options.scene.source;
  report.scene_name = scene.name.empty() ? fs::path(options.scene.source).filename().string() : scene.name;
  report.scene_hash = scene_hash(scene);
  report.triangles = scene.triangles.size();
  report.clock = options.clock;
  report.peer_note = why_no_embree();
  report.options = {{"rays", joined(options.kinds)},
                    {"methods", options.methods.empty() ? "all" : joined(options.methods)},
                    {"rays of each kind", std::to_string(options.run.ray_count)},
                    {"rays judged of each kind", std::to_string(options.run.judged_rays)},
                    {"rays predictions are held against", std::to_string(options.run.predicted_rays)},
                    {"rounds", std::to_string(options.run.rounds)},
                    {"seed of rays", std::to_string(options.run.seed)},
                    {"bins", std::to_string(BuildOptions{}.bins)},
                    {"triangles in a leaf", std::to_string(BuildOptions{}.max_leaf_size)},
                    {"invalid triangles", options.scene.invalid}};
  return report;
}

compare::DeviceReport start_device(const cl::DeviceInfo& info) {
  compare::DeviceReport device;
  device.name = info.name;
  device.driver = info.driver;
  device.platform = info.platform_name;
  device.opencl = info.version;
  device.kind = kind_of(info);
  device.compute_units = info.compute_units;
  return device;
}

// The same work: other rows would be taken for its own. The time it may take is not part of that.
bool same_work(const compare::Report& a, const compare::Report& b) {
  return a.commit == b.commit && a.scene_hash == b.scene_hash && a.options == b.options &&
         a.peer_note == b.peer_note;
}

class Comparison {
 public:
  Comparison(const CompareOptions& options, Console& console)
      : options_(options), console_(console), files_(options.page) {
    options_.run.kinds = options_.kinds;
    options_.run.methods = options_.methods;
    options_.run.seconds = seconds_from(options_.time);
    options_.run.check();
    if (!options_.rows.empty()) append_to_file(options_.rows, {});  // before all is measured, not after
    const auto known = cl::list_devices();
    if (options_.devices.empty()) devices_.push_back(cl::choose_device(known, ""));
    for (const std::string& choice : options_.devices) devices_.push_back(cl::choose_device(known, choice));
  }

  int run() {
    const Scene scene = load_scene(options_.scene, console_);
    report_ = start_report(options_, scene);
    go_on_from_file();
    // Several devices share the time, and the contest between them has a share, too.
    const std::size_t shares = devices_.size() > 1 ? devices_.size() + 1 : 1;
    const double share = options_.run.seconds / static_cast<double>(shares);
    for (const cl::DeviceInfo& info : devices_) run_on(info, scene, share);
    if (devices_.size() > 1) set_beside_each_other(scene, share);
    const std::size_t charts = files_.write_all(report_);
    if (!options_.rows.empty()) append_rows(options_.rows, report_);
    tell(charts);
    return judge_ours();
  }

 private:
  void go_on_from_file() {
    if (options_.afresh || !files_.has_rows()) return;
    const compare::Report old = files_.read_rows();
    if (!same_work(report_, old)) {
      console_.note(files_.rows().string() +
                    " is of another scene, commit or options: measuring anew, and it will be replaced");
      return;
    }
    report_.devices = old.devices;
    console_.note("going on from " + files_.rows().string() + " (--afresh measures anew)");
  }

  [[nodiscard]] cl::ContextOptions how_to_open() const {
    cl::ContextOptions how;
    how.use_cache = !options_.no_cache;
    return how;
  }

  void set_beside_each_other(const Scene& scene, double seconds) {
    std::vector<std::unique_ptr<cl::Context>> contexts;
    std::vector<compare::AcrossDevice> devices;
    for (const cl::DeviceInfo& info : devices_) {
      compare::DeviceReport* const report = &report_.devices[place_of(info)];
      if (std::any_of(devices.begin(), devices.end(),
                      [&](const auto& known) { return known.report == report; }))
        continue;
      contexts.push_back(std::make_unique<cl::Context>(info, how_to_open()));
      devices.push_back({contexts.back().get(), report});
    }
    compare::RunOptions run = options_.run;
    run.seconds = seconds;
    compare::run_across(
        devices, scene, run, [this] { files_.keep_rows(report_); }, console_.progress());
  }

  // Of the device in the report; a new one at its end.
  std::size_t place_of(const cl::DeviceInfo& info) {
    const auto found = std::find_if(report_.devices.begin(), report_.devices.end(), [&](const auto& device) {
      return device.name == info.name && device.driver == info.driver &&
             device.platform == info.platform_name;
    });
    const auto place = static_cast<std::size_t>(found - report_.devices.begin());
    if (found == report_.devices.end()) report_.devices.push_back(start_device(info));
    return place;
  }

  void run_on(const cl::DeviceInfo& info, const Scene& scene, double seconds) {
    const std::size_t place = place_of(info);
    const cl::Context context(info, how_to_open());
    std::vector<compare::Method> methods = compare::own_methods(
        context, scene, {options_.run.kinds, options_.run.seed, device_builder(context)});
    // Peers come before methods that compile kernels of their own: where time is short, those are left out.
    std::vector<compare::Method> peers = embree_methods(info, scene);
    methods.insert(methods.begin() + compare::kFirstMethods, std::make_move_iterator(peers.begin()),
                   std::make_move_iterator(peers.end()));
    compare::RunOptions run = options_.run;
    run.seconds = seconds;
    run.at_size = at_sizes(options_.scene);
    run.plan = device_builder(context);
    compare::run_device(
        context, scene, methods, run, report_.devices[place], [this] { files_.keep_rows(report_); },
        console_.progress());
  }

  // 6 where a method that promises exact hits has wrong ones.
  int judge_ours() {
    int status = kOk;
    for (const compare::DeviceReport& device : report_.devices) {
      for (const compare::AccuracyRow& row : device.accuracies) {
        const bool promised =
            std::any_of(device.methods.begin(), device.methods.end(),
                        [&](const auto& method) { return method.name == row.method && method.exact; });
        if (!promised || row.wrong() == 0) continue;
        console_.error(device.name + ", " + row.method + ": " + std::to_string(row.wrong()) + " of " +
                       std::to_string(row.judged) + " " + row.kind + " rays have wrong answers");
        status = kMismatch;
      }
    }
    return status;
  }

  void tell(std::size_t charts) {
    Json document = start_document("compare");
    document["page"] = options_.page;
    document["rows"] = files_.rows().string();
    document["charts"] = charts;
    document["scene_hash"] = report_.scene_hash;
    document["devices"] = Json::array();
    std::string text;
    for (const compare::DeviceReport& device : report_.devices) {
      const compare::Advice advice = advise(report_, device);
      document["devices"].push_back(
          {{"device", device.name}, {"best", advice.best}, {"advice", advice.all()}});
      for (const std::string& sentence : advice.all())
        if (!sentence.empty()) text += sentence + "\n";
      for (const compare::LeftOut& left : device.left_out)
        console_.note("left out: " + (left.method.empty() ? "" : left.method + ", ") + left.what + ": " +
                      left.reason);
    }
    if (!report_.peer_note.empty()) console_.note(report_.peer_note);
    console_.print(document);
    console_.print(text + "\npage    " + options_.page + "\nrows    " + files_.rows().string() + "\n");
  }

  CompareOptions options_;
  Console& console_;
  ReportFiles files_;
  std::vector<cl::DeviceInfo> devices_;
  compare::Report report_;
};

}  // namespace

int compare_methods(const CompareOptions& options, Console& console) {
  return Comparison(options, console).run();
}

}  // namespace gnomon::app
