// Which triangles can be traced and what happens to the others: one policy for every importer. Not for
// repairing them. Feeds the importers.
#pragma once

#include <cstdint>
#include <string>
#include <utility>

#include "gnomon/scene/import.h"
#include "gnomon/scene/scene.h"

namespace gnomon {

enum class TriangleFault {
  kNone,
  kNotFinite,  // a NaN, an infinity or a magnitude above kMaxCoordinate
  kZeroArea,   // three corners equal or on one line
};

// Slivers are fine: only a cross product that is zero counts as zero area. It is taken in double precision,
// where products of nearby floats' differences are exact, and checked again without rounding where it comes
// out zero.
[[nodiscard]] TriangleFault fault_of(const Triangle& triangle);

// Appends valid triangles to a scene and applies the InvalidPolicy to the others.
class TriangleSink {
 public:
  TriangleSink(Scene& scene, InvalidPolicy policy) : scene_(scene), policy_(policy) {}

  // True when the triangle was kept: it is then the scene's last. `place()` gives the text that names it and
  // is called only for the error. Throws Error{kBadScene} for a faulty triangle under InvalidPolicy::kReject.
  template <typename Place>
  bool add(const Triangle& triangle, std::uint32_t material_id, const Place& place) {
    const TriangleFault fault = fault_of(triangle);
    const bool kept = fault == TriangleFault::kZeroArea && policy_ == InvalidPolicy::kKeepFlat;
    if (fault != TriangleFault::kNone && !kept) {
      if (policy_ == InvalidPolicy::kReject) reject(fault, place());
      count(fault);
      return false;
    }
    scene_.triangles.push_back(triangle);
    scene_.material_ids.push_back(material_id);
    return true;
  }

 private:
  [[noreturn]] static void reject(TriangleFault fault, const std::string& place);
  void count(TriangleFault fault);

  Scene& scene_;
  InvalidPolicy policy_;
};

// A coordinate as the scene stores it: NaN for what a triangle may not have, so that fault_of finds it.
[[nodiscard]] float to_coordinate(double value);

// Throws Error{kBadScene} when `triangles` more than `so_far` would pass the limit.
void require_room(std::uint64_t so_far, std::uint64_t triangles, const ImportOptions& options);

// Throws Error{kBadScene} for a scene without triangles, saying what was left out on the way.
void require_triangles(const Scene& scene);

}  // namespace gnomon
