// Embree 3.13 as the peer: the same triangles, rays and answers as ours, in the calls and modes worth
// comparing with. Not for timing (paired.h). Feeds benches and
// gnomon compare.
#pragma once

#include <embree3/rtcore.h>

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "gnomon/scene/ray_set.h"
#include "gnomon/scene/scene.h"

namespace gnomon::peers {

enum class EmbreeQuality { kLow, kMedium, kHigh };
[[nodiscard]] const char* to_string(EmbreeQuality quality);

class EmbreeScene {
 public:
  // robust: RTC_SCENE_FLAG_ROBUST, with which kHigh silently builds what kMedium does. threads: of build()
  // and of the tracing calls.
  EmbreeScene(std::span<const GnTriangle> triangles, EmbreeQuality quality, bool robust,
              unsigned threads = 1);
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;
  ~EmbreeScene();

  // Geometry from unshared corners, as we take them; the copy into Embree's buffers is inside, as our upload
  // is.
  void build();

  // Each fills a ray structure per ray from the batch and writes its answer back, as any caller with a batch
  // must. The calls for 16 rays take them as they come.
  void closest(std::span<const Ray> rays, std::span<Hit> hits) const;
  void any(std::span<const Ray> rays, std::span<std::uint32_t> occluded) const;
  void closest16(std::span<const Ray> rays, std::span<Hit> hits) const;
  void any16(std::span<const Ray> rays, std::span<std::uint32_t> occluded) const;

  // Held by Embree for the scene as built: nodes, triangles and its copy of the corners.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }

  [[nodiscard]] std::string name() const;  // "MEDIUM", "MEDIUM ROBUST" ...

 private:
  template <typename Work>
  void share(std::size_t rays, const Work& work) const;

  std::span<const GnTriangle> triangles_;
  EmbreeQuality quality_;
  bool robust_;
  unsigned threads_;
  std::atomic<std::int64_t> bytes_{0};
  RTCDevice device_ = nullptr;
  RTCScene scene_ = nullptr;
};

}  // namespace gnomon::peers
