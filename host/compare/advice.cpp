// The first paragraphs of a report. Nothing is claimed that all rounds do not agree on.
#include <algorithm>

#include "gnomon/compare/analysis.h"
#include "gnomon/compare/method.h"
#include "gnomon/compare/words.h"

namespace gnomon::compare {
namespace {

std::string range(const Spread& s) {
  return fixed(s.median, 2) + " (" + fixed(s.min, 2) + " to " + fixed(s.max, 2) + ")";
}

class Adviser {
 public:
  Adviser(const Report& report, const DeviceReport& device) : report_(report), device_(device) {}

  Advice advise() {
    Advice advice;
    if (kinds_of(device_).empty() || lines_of(device_, kAllKinds, report_.clock).empty()) {
      advice.use = "Nothing was traced by all methods yet, so there is nothing to advise.";
      return advice;
    }
    choose();
    advice.best = best_;
    advice.use = use();
    advice.how = how();
    if (best_ != kBaseline) {
      advice.gain = gain();
      advice.cost = cost();
    }
    advice.no_gain = no_gain();
    advice.accuracy = accuracy();
    return advice;
  }

 private:
  [[nodiscard]] Spread gain_of(const std::string& method, const std::string& kind) const {
    return trace_gain(device_, kBaseline, method, kind, report_.clock);
  }

  // Ours, and with the baseline's answers to the last bit: a faster method with other answers is no
  // replacement.
  [[nodiscard]] bool may_replace(const MethodFacts& method) const {
    if (method.family == Family::kPeer) return false;
    return std::all_of(device_.accuracies.begin(), device_.accuracies.end(), [&](const AccuracyRow& row) {
      return row.method != method.name || row.method == kBaseline || row.same_as == kBaseline;
    });
  }

  void choose() {
    std::vector<Line> lines = lines_of(device_, kAllKinds, report_.clock);
    std::erase_if(lines, [&](const Line& line) {
      const auto method = std::find_if(device_.methods.begin(), device_.methods.end(),
                                       [&](const MethodFacts& facts) { return facts.name == line.method; });
      if (!may_replace(*method)) return true;
      if (line.method == kBaseline) return false;
      return verdict_of(gain_of(line.method, kAllKinds)) != Verdict::kFaster &&
             verdict_of(build_gain(device_, kBaseline, line.method, report_.clock)) != Verdict::kFaster;
    });
    // What only builds faster may be best for few rays; for many, tracing must be faster beyond the spread,
    // or the baseline stays.
    std::vector<Line> sure;
    for (const Line& line : lines) {
      candidates_.push_back(line.method);
      Line judged = line;
      if (line.method != kBaseline && verdict_of(gain_of(line.method, kAllKinds)) == Verdict::kUndecided) {
        const auto base =
            std::find_if(lines.begin(), lines.end(), [](const Line& l) { return l.method == kBaseline; });
        if (base != lines.end()) judged.ray_s = std::max(judged.ray_s, base->ray_s);
      }
      sure.push_back(judged);
    }
    reigns_ = fastest_by_rays(sure);
    for (std::string idle = without_use(); !idle.empty(); idle = without_use()) {
      std::erase_if(sure, [&](const Line& line) { return line.method == idle; });
      reigns_ = fastest_by_rays(sure);
    }
    best_ = reigns_.empty() ? kBaseline : reigns_.back().method;
  }

  // Of two that reign one after the other, the second is to trace faster in every round, and the first to
  // build faster. The name of one that was not shown to, or nothing.
  std::string without_use() {
    for (std::size_t i = 1; i < reigns_.size(); ++i) {
      const std::string& before = reigns_[i - 1].method;
      const std::string& after = reigns_[i].method;
      const Spread trace = trace_gain(device_, before, after, kAllKinds, report_.clock);
      if (verdict_of(trace) != Verdict::kFaster) {
        not_shown_.push_back({after, before, trace});
        return after;
      }
      // What is built in one round, because it takes so long, is not in question.
      const Spread build = build_gain(device_, after, before, report_.clock);
      if (build.count > 1 && verdict_of(build) != Verdict::kFaster) return before;
    }
    return "";
  }

  [[nodiscard]] std::string use() const {
    const std::string where = "On " + device_.name + ", for " + report_.scene_name + " (" +
                              std::to_string(report_.triangles) + " triangles) and as many rays each of " +
                              list_text(kinds_of(device_)) + ": ";
    if (reigns_.size() <= 1) return where + "use " + best_ + ", however many rays you trace per build.";
    std::string out = where;
    for (std::size_t i = 0; i < reigns_.size(); ++i) {
      const bool last = i + 1 == reigns_.size();
      if (last) {
        out += "beyond " + count_text(reigns_[i].from_rays) + " rays use " + reigns_[i].method + ".";
      } else {
        out += std::string(i == 0 ? "for up to " : "up to ") + count_text(reigns_[i + 1].from_rays) +
               " rays per build use " + reigns_[i].method + ", ";
      }
    }
    return out;
  }

  // The program's options for what is advised.
  [[nodiscard]] std::string how() const {
    std::vector<std::string> items;
    for (const Reign& reign : reigns_) {
      const auto facts = std::find_if(device_.methods.begin(), device_.methods.end(),
                                      [&](const MethodFacts& m) { return m.name == reign.method; });
      if (facts != device_.methods.end() && !facts->options.empty())
        items.push_back(reign.method + " is " + facts->options + " (" + facts->what + ")");
    }
    return items.empty() ? "" : "With gnomon build: " + list_text(items) + ".";
  }

  [[nodiscard]] std::string gain() const {
    const Spread all = gain_of(best_, kAllKinds);
    if (verdict_of(all) != Verdict::kFaster)
      return best_ + " builds faster than " + kBaseline +
             "; for tracing the rounds do not agree which is faster.";
    std::string out = best_ + " traces " + range(all) + " times as fast as " + kBaseline + " over all kinds";
    out += all.count > 1 ? ": the median of " + std::to_string(all.count) +
                               " paired rounds and their range, which holds the true median with " +
                               fixed(100.0 * certainty(all.count), 1) + " % certainty."
                         : ", in a single round: a hint, no more.";
    std::vector<std::string> by_kind;
    for (const std::string& kind : kinds_of(device_))
      by_kind.push_back(kind + " " + range(gain_of(best_, kind)));
    out += " By kind: " + list_text(by_kind) + ".";
    for (const std::string& kind : kinds_of(device_)) {
      std::string winner = best_;
      for (const std::string& name : candidates_) {
        const Spread own = gain_of(name, kind);
        if (verdict_of(own) == Verdict::kFaster && own.min > gain_of(winner, kind).max) winner = name;
      }
      if (winner != best_)
        out += " For " + kind + " rays alone " + winner +
               " is faster still: " + range(gain_of(winner, kind)) + ".";
    }
    return out;
  }

  [[nodiscard]] std::string cost() const {
    const auto row = [&](const std::string& name) {
      return std::find_if(device_.builds.begin(), device_.builds.end(),
                          [&](const BuildRow& r) { return r.method == name; });
    };
    const auto own = row(best_);
    const auto base = row(kBaseline);
    const double own_s = spread_of(seconds_of(own->rounds, report_.clock)).median;
    const double base_s = spread_of(seconds_of(base->rounds, report_.clock)).median;
    const auto lines = lines_of(device_, kAllKinds, report_.clock);
    const auto line = [&](const std::string& name) {
      return *std::find_if(lines.begin(), lines.end(), [&](const Line& l) { return l.method == name; });
    };
    const Spread dearer = build_gain(device_, best_, kBaseline, report_.clock);
    std::string out = "It costs " + (dearer.count > 1 ? range(dearer) : fixed(own_s / base_s, 2)) +
                      " times the build time (" + time_text(own_s) + " against " + time_text(base_s) +
                      (dearer.count > 1 ? ") and " : ", of one round) and ") +
                      fixed(static_cast<double>(own->bytes) / static_cast<double>(base->bytes), 2) +
                      " times the memory (" + bytes_text(static_cast<double>(own->bytes)) + " against " +
                      bytes_text(static_cast<double>(base->bytes)) + ").";
    if (const auto even = break_even(line(kBaseline), line(best_)); even && *even > 0.0)
      out += " Tracing pays that back after about " + count_text(*even) + " rays.";
    return out;
  }

  // Where the best is no better, and which others never are.
  [[nodiscard]] std::string no_gain() const {
    std::string out;
    if (best_ == kBaseline) {
      out = "No method here with the same answers traces faster than " + std::string(kBaseline) +
            " over all kinds by more than the rounds vary.";
    } else {
      std::vector<std::string> kinds;
      for (const std::string& kind : kinds_of(device_))
        if (verdict_of(gain_of(best_, kind)) != Verdict::kFaster) kinds.push_back(kind);
      if (kinds.empty()) {
        out = "It is faster in every round for every kind of rays here.";
      } else if (kinds.size() < kinds_of(device_).size()) {
        out = "It is no better than " + std::string(kBaseline) + " for " + list_text(kinds) +
              " rays: there the rounds do not agree that it is faster.";
      }
    }
    std::vector<std::string> never;
    for (const MethodFacts& method : device_.methods) {
      if (method.name == kBaseline || method.name == best_ || method.family == Family::kPeer ||
          !may_replace(method))
        continue;
      bool faster = false;
      for (const std::string& kind : kinds_of(device_))
        faster = faster || verdict_of(gain_of(method.name, kind)) == Verdict::kFaster;
      if (!faster) never.push_back(method.name);
    }
    if (!never.empty()) {
      out += (out.empty() ? "" : " ") + std::string("Not faster than ") + kBaseline +
             " for any kind: " + list_text(never) + ".";
    }
    for (const auto& [method, other, gain] : not_shown_) {
      if (method != kBaseline && verdict_of(gain_of(method, kAllKinds)) != Verdict::kFaster) continue;
      out += " No difference was shown between tracing by " + method + " and by " + other +
             ", which builds sooner: " + range(gain) + " times as fast.";
    }
    return out;
  }

  [[nodiscard]] std::string accuracy() const {
    const Wrong base = wrong_of(device_, kBaseline);
    if (base.judged == 0) return "No answer was judged against the oracle.";
    std::string out =
        std::string(kBaseline) +
        " and all that may take its place answer with the same bits: " + std::to_string(base.wrong) + " of " +
        std::to_string(base.judged) + " judged rays wrong";
    out += base.wrong == 0 ? " (so fewer than " + significant(3e6 / static_cast<double>(base.judged), 2) +
                                 " in a million, with 95 % certainty)."
                           : ".";
    std::vector<std::string> others;
    for (const MethodFacts& method : device_.methods) {
      const Wrong own = wrong_of(device_, method.name);
      if (own.judged == 0 || (method.family != Family::kPeer && may_replace(method))) continue;
      others.push_back(method.name + " " + std::to_string(own.wrong) + " of " + std::to_string(own.judged));
    }
    if (!others.empty()) out += " Others: " + list_text(others) + " wrong.";
    return out;
  }

  const Report& report_;
  const DeviceReport& device_;
  std::vector<std::string> candidates_;
  std::vector<Reign> reigns_;
  struct NotShown {
    std::string method, other;
    Spread gain;  // of method over other, in tracing
  };
  std::vector<NotShown> not_shown_;
  std::string best_ = kBaseline;
};

}  // namespace

Advice advise(const Report& report, const DeviceReport& device) {
  return Adviser(report, device).advise();
}

}  // namespace gnomon::compare
