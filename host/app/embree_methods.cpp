#include "embree_methods.h"

#ifdef GNOMON_HAS_EMBREE
#include "gnomon/peers/embree_peer.h"
#endif

namespace gnomon::app {

#ifdef GNOMON_HAS_EMBREE
namespace {

using peers::EmbreeQuality;
using peers::EmbreeScene;

class EmbreeEntrant : public compare::Entrant {
 public:
  EmbreeEntrant(const Scene& scene, bool robust, unsigned threads)
      : embree_(scene.triangles, EmbreeQuality::kMedium, robust, threads) {}

  void build(const Progress&) override { embree_.build(); }

  // Rays that run together go in packets, as ours do. Answers are written back, as any caller with a batch
  // must.
  void trace(const compare::Batch& batch) override {
    answers_.hits.resize(batch.rays.size());
    answers_.occluded.resize(batch.rays.size());
    if (batch.any_hit) {
      embree_.any16(batch.rays, answers_.occluded);
    } else if (batch.kind == "primary") {
      embree_.closest16(batch.rays, answers_.hits);
    } else {
      embree_.closest(batch.rays, answers_.hits);
    }
  }

  compare::Answers answers(const compare::Batch& batch) override {
    compare::Answers answers;
    answers.hits = closest(batch.rays);
    answers.occluded.resize(batch.rays.size());
    embree_.any(batch.rays, answers.occluded);
    return answers;
  }

  std::vector<Hit> closest(std::span<const Ray> rays) override {
    std::vector<Hit> hits(rays.size());
    embree_.closest(rays, hits);
    return hits;
  }

  compare::BuildRow facts() override {
    compare::BuildRow row;
    row.bytes = static_cast<std::uint64_t>(embree_.bytes());
    row.flavour = "Embree";
    return row;
  }

 private:
  EmbreeScene embree_;
  compare::Answers answers_;
};

}  // namespace

std::vector<compare::Method> embree_methods(const cl::DeviceInfo& device, const Scene& scene) {
  std::vector<compare::Method> methods;
  if (!device.is_cpu) return methods;
  for (const bool robust : {false, true}) {
    methods.push_back(
        {{robust ? "embree-robust" : "embree-default", compare::Family::kPeer,
          std::string("Embree ") + RTC_VERSION_STRING + ", MEDIUM quality" +
              (robust ? ", RTC_SCENE_FLAG_ROBUST" : "") + ", " + std::to_string(device.compute_units) +
              " threads; memory with its copy of the corners",
          ""},
         [&scene, robust, threads = device.compute_units] {
           return std::make_unique<EmbreeEntrant>(scene, robust, threads);
         }});
  }
  return methods;
}

std::string why_no_embree() {
  return "";
}
#else
std::vector<compare::Method> embree_methods(const cl::DeviceInfo&, const Scene&) {
  return {};
}

std::string why_no_embree() {
  return "Embree was not there when this program was built (Debian: libembree-dev), so no peer was measured";
}
#endif

}  // namespace gnomon::app
