#include "gnomon/compare/analysis.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace gnomon::compare {
namespace {

const BuildRow* build_of(const DeviceReport& device, const std::string& method) {
  const auto found = std::find_if(device.builds.begin(), device.builds.end(),
                                  [&](const BuildRow& row) { return row.method == method; });
  return found == device.builds.end() ? nullptr : &*found;
}

// Seconds a ray in each round; kAllKinds: the mean over kinds, in rounds that all of them have. Empty where
// one is missing.
std::vector<double> ray_seconds(const DeviceReport& device, const std::string& method,
                                const std::string& kind, const std::string& clock) {
  std::vector<double> sums;
  std::size_t kinds = 0;
  for (const TraceRow& row : device.traces) {
    if (row.method != method || (kind != kAllKinds && row.kind != kind) || row.rays == 0) continue;
    const std::vector<double>& seconds = seconds_of(row.rounds, clock);
    if (kinds++ == 0) {
      sums.assign(seconds.size(), 0.0);
    } else {
      sums.resize(std::min(sums.size(), seconds.size()));
    }
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += seconds[i] / static_cast<double>(row.rays);
  }
  if (kind == kAllKinds && kinds != kinds_of(device).size()) return {};
  for (double& sum : sums) sum /= static_cast<double>(kinds);
  return sums;
}

}  // namespace

Spread ratios(const std::vector<double>& base, const std::vector<double>& own) {
  std::vector<double> out;
  for (std::size_t i = 0; i < std::min(base.size(), own.size()); ++i)
    if (own[i] > 0.0) out.push_back(base[i] / own[i]);
  return spread_of(out);
}

std::vector<std::string> kinds_of(const DeviceReport& device) {
  std::vector<std::string> kinds;
  for (const TraceRow& row : device.traces)
    if (std::find(kinds.begin(), kinds.end(), row.kind) == kinds.end()) kinds.push_back(row.kind);
  return kinds;
}

std::vector<Line> lines_of(const DeviceReport& device, const std::string& kind, const std::string& clock) {
  std::vector<Line> lines;
  for (const MethodFacts& method : device.methods) {
    const BuildRow* build = build_of(device, method.name);
    const std::vector<double> rays = ray_seconds(device, method.name, kind, clock);
    if (build == nullptr || rays.empty() || seconds_of(build->rounds, clock).empty()) continue;
    lines.push_back(
        {method.name, spread_of(seconds_of(build->rounds, clock)).median, spread_of(rays).median});
  }
  return lines;
}

std::optional<double> break_even(const Line& base, const Line& other) {
  const double dearer = other.build_s - base.build_s;
  const double saved = base.ray_s - other.ray_s;
  if (dearer <= 0.0 && saved >= 0.0) return 0.0;
  if (saved <= 0.0) return std::nullopt;  // its lead, if any, is at the beginning only
  return dearer / saved;
}

std::vector<Reign> fastest_by_rays(const std::vector<Line>& lines) {
  std::vector<Reign> reigns;
  if (lines.empty()) return reigns;
  const auto first = std::min_element(lines.begin(), lines.end(), [](const Line& a, const Line& b) {
    return a.build_s < b.build_s || (a.build_s == b.build_s && a.ray_s < b.ray_s);
  });
  const Line* now = &*first;
  reigns.push_back({now->method, 0.0});
  while (true) {
    const Line* next = nullptr;
    double at = std::numeric_limits<double>::infinity();
    for (const Line& line : lines) {
      if (line.ray_s >= now->ray_s) continue;
      const double meet = std::max(0.0, (line.build_s - now->build_s) / (now->ray_s - line.ray_s));
      if (meet < at || (meet == at && next != nullptr && line.ray_s < next->ray_s)) {
        next = &line;
        at = meet;
      }
    }
    if (next == nullptr) return reigns;
    if (at <= reigns.back().from_rays) reigns.pop_back();
    reigns.push_back({next->method, at});
    now = next;
  }
}

std::vector<std::size_t> pareto_front(const std::vector<Point>& points) {
  std::vector<std::size_t> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return points[a].x < points[b].x || (points[a].x == points[b].x && points[a].y < points[b].y);
  });
  std::vector<std::size_t> front;
  for (const std::size_t i : order)
    if (front.empty() || points[i].y < points[front.back()].y) front.push_back(i);
  return front;
}

Spread trace_gain(const DeviceReport& device, const std::string& base, const std::string& method,
                  const std::string& kind, const std::string& clock) {
  return ratios(ray_seconds(device, base, kind, clock), ray_seconds(device, method, kind, clock));
}

Spread build_gain(const DeviceReport& device, const std::string& base, const std::string& method,
                  const std::string& clock) {
  const BuildRow* const a = build_of(device, base);
  const BuildRow* const b = build_of(device, method);
  if (a == nullptr || b == nullptr) return {};
  return ratios(seconds_of(a->rounds, clock), seconds_of(b->rounds, clock));
}

Spread across_gain(const Report& report, const DeviceReport& device, const std::string& kind) {
  const auto row = [&](const DeviceReport& of) {
    const auto found =
        std::find_if(of.across.begin(), of.across.end(), [&](const AcrossRow& r) { return r.kind == kind; });
    return found == of.across.end() ? std::vector<double>{} : seconds_of(found->rounds, report.clock);
  };
  return ratios(row(report.devices.front()), row(device));
}

Verdict verdict_of(const Spread& gain) {
  // One round has no spread, so nothing is sure.
  if (gain.count < 2) return Verdict::kUndecided;
  if (gain.min > 1.0) return Verdict::kFaster;
  return gain.max < 1.0 ? Verdict::kSlower : Verdict::kUndecided;
}

double certainty(std::size_t rounds) {
  return rounds == 0 ? 0.0 : 1.0 - std::exp2(1.0 - static_cast<double>(rounds));
}

Wrong wrong_of(const DeviceReport& device, const std::string& method) {
  Wrong sum;
  for (const AccuracyRow& row : device.accuracies) {
    if (row.method != method) continue;
    sum.wrong += row.wrong();
    sum.judged += row.judged;
  }
  return sum;
}

}  // namespace gnomon::compare
