#include "gnomon/compare/report_json.h"

#include <algorithm>
#include <sstream>

#include "gnomon/base/error.h"
#include "gnomon/compare/base64.h"
#include "gnomon/compare/report_rows.h"

namespace gnomon::compare {
namespace {

Json methods_json(const DeviceReport& device) {
  Json out = Json::array();
  for (const MethodFacts& m : device.methods)
    out.push_back({{"name", m.name},
                   {"family", to_string(m.family)},
                   {"what", m.what},
                   {"options", m.options},
                   {"exact", m.exact}});
  return out;
}

void put_facts(Json& out, const DeviceReport& device) {
  out["device"] = device.name;
  out["driver"] = device.driver;
  out["platform"] = device.platform;
  out["opencl"] = device.opencl;
  out["device_kind"] = device.kind;
  out["compute_units"] = device.compute_units;
  out["complete"] = device.complete;
  out["methods"] = methods_json(device);
}

void put_facts(Json& out, const Report& report) {
  out["version"] = report.version;
  out["commit"] = report.commit;
  out["command"] = report.command;
  out["scene"] = report.scene;
  out["scene_name"] = report.scene_name;
  out["scene_hash"] = report.scene_hash;
  out["triangles"] = report.triangles;
  out["clock"] = report.clock;
  out["peer_note"] = text_or_null(report.peer_note);
  out["options"] = Json::object();
  for (const auto& [name, value] : report.options) out["options"][name] = value;
}

Json device_json(const Report& report, const DeviceReport& device) {
  Json out;
  put_facts(out, device);
  out["done"] = device.done;
  out["rows"] = rows_of(report, device);
  Json png = Json::object();
  for (const auto& [name, bytes] : device.pictures.png) png[name] = to_base64(bytes);
  out["pictures"] = {{"width", device.pictures.width},
                     {"height", device.pictures.height},
                     {"white", device.pictures.white},
                     {"mean", device.pictures.mean},
                     {"png", png}};
  return out;
}

Family family_from(const std::string& name) {
  for (const Family family : {Family::kSurface, Family::kRays, Family::kMixture, Family::kPeer})
    if (name == to_string(family)) return family;
  throw Error(ErrorCode::kBadScene, "\"" + name + "\" is no family of methods");
}

void read_facts(const Json& in, DeviceReport& device) {
  device.name = in.at("device");
  device.driver = in.at("driver");
  device.platform = in.at("platform");
  device.opencl = in.at("opencl");
  device.kind = in.at("device_kind");
  device.compute_units = in.at("compute_units");
  device.complete = in.at("complete");
  for (const Json& m : in.at("methods"))
    device.methods.push_back(
        {m.at("name"), family_from(m.at("family")), m.at("what"), m.at("options"), m.at("exact")});
}

void read_facts(const Json& in, Report& report) {
  report.version = in.at("version");
  report.commit = in.at("commit");
  report.command = in.at("command");
  report.scene = in.at("scene");
  report.scene_name = in.at("scene_name");
  report.scene_hash = in.at("scene_hash");
  report.triangles = in.at("triangles");
  report.clock = in.at("clock");
  report.peer_note = text_of(in.at("peer_note"));
  report.options.clear();
  for (const auto& [name, value] : in.at("options").items()) report.options.emplace_back(name, value);
}

DeviceReport read_device(const Json& in) {
  DeviceReport device;
  read_facts(in, device);
  device.done = in.at("done").get<std::vector<std::string>>();
  for (const Json& row : in.at("rows")) read_row(row, device);
  const Json& pictures = in.at("pictures");
  device.pictures.width = pictures.at("width");
  device.pictures.height = pictures.at("height");
  device.pictures.white = pictures.at("white");
  device.pictures.mean = pictures.at("mean").get<std::map<std::string, double>>();
  for (const auto& [name, text] : pictures.at("png").items()) device.pictures.png[name] = from_base64(text);
  return device;
}

// What a device's rows do not say of themselves.
Json run_row(const Report& report, const DeviceReport& device) {
  Json row{{"schema", kSchema}, {"bench", "compare"}, {"task", "run"}};
  put_facts(row, report);
  put_facts(row, device);
  return row;
}

}  // namespace

std::string to_rows_text(const Report& report) {
  std::string out;
  const auto put = [&](const Json& row) {
    out += row.dump(-1, ' ', false, Json::error_handler_t::replace) + "\n";
  };
  for (const DeviceReport& device : report.devices) {
    put(run_row(report, device));
    for (const Json& row : rows_of(report, device)) put(row);
  }
  return out;
}

std::vector<Report> from_rows_text(const std::string& text, const std::string& source) {
  std::vector<Report> reports;
  std::size_t number = 0;
  try {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      ++number;
      if (line.empty()) continue;
      const Json row = Json::parse(line);
      if (row.at("bench") != "compare" || row.at("schema") != kSchema)
        throw Error(ErrorCode::kBadScene, "not a row of a comparison, schema " + std::to_string(kSchema));
      if (row.at("task") == "run") {
        // Runs of several devices are rows of one command.
        if (reports.empty() || reports.back().command != row.at("command") ||
            reports.back().commit != row.at("commit") || reports.back().scene_hash != row.at("scene_hash"))
          reports.emplace_back();
        read_facts(row, reports.back());
        read_facts(row, reports.back().devices.emplace_back());
      } else if (reports.empty()) {
        throw Error(ErrorCode::kBadScene, "no row of task run before it");
      } else {
        read_row(row, reports.back().devices.back());
      }
    }
  } catch (const std::exception& error) {
    throw Error(ErrorCode::kBadScene, source + ", line " + std::to_string(number) + ": " + error.what());
  }
  return reports;
}

std::string to_json_text(const Report& report) {
  Json out{{"schema", kSchema}, {"bench", "compare"}, {"complete", report.complete()}};
  put_facts(out, report);
  out["devices"] = Json::array();
  for (const DeviceReport& device : report.devices) out["devices"].push_back(device_json(report, device));
  return out.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Report from_json_text(const std::string& text, const std::string& source) {
  try {
    const Json in = Json::parse(text);
    if (in.at("bench") != "compare") throw Error(ErrorCode::kBadScene, "it is of another bench");
    if (in.at("schema") != kSchema)
      throw Error(ErrorCode::kBadScene, "its schema is " + in.at("schema").dump() + ", this program reads " +
                                            std::to_string(kSchema));
    Report report;
    read_facts(in, report);
    for (const Json& device : in.at("devices")) report.devices.push_back(read_device(device));
    return report;
  } catch (const std::exception& error) {
    throw Error(ErrorCode::kBadScene, source + " is not a report that can be gone on from: " + error.what() +
                                          "; move it away, or choose another name with -o");
  }
}

}  // namespace gnomon::compare
