#include "gnomon/peers/embree_peer.h"

#include <algorithm>
#include <thread>

namespace gnomon::peers {
namespace {

RTCBuildQuality rtc_quality(EmbreeQuality quality) {
  switch (quality) {
    case EmbreeQuality::kLow:
      return RTC_BUILD_QUALITY_LOW;
    case EmbreeQuality::kMedium:
      return RTC_BUILD_QUALITY_MEDIUM;
    case EmbreeQuality::kHigh:
      return RTC_BUILD_QUALITY_HIGH;
  }
  return RTC_BUILD_QUALITY_MEDIUM;
}

RTCRay load(const Ray& r) {
  RTCRay ray{};
  ray.org_x = r.origin[0];
  ray.org_y = r.origin[1];
  ray.org_z = r.origin[2];
  ray.tnear = r.tmin;
  ray.dir_x = r.direction[0];
  ray.dir_y = r.direction[1];
  ray.dir_z = r.direction[2];
  ray.tfar = r.tmax;
  ray.mask = 0xffffffffU;
  return ray;
}

constexpr std::size_t kPacket = 16;

// Rays [first, first + kPacket) side by side; those past the end are switched off.
void load16(std::span<const Ray> rays, std::size_t first, RTCRay16& packet, int* valid) {
  for (std::size_t i = 0; i < kPacket; ++i) {
    valid[i] = first + i < rays.size() ? -1 : 0;
    const Ray& r = rays[std::min(first + i, rays.size() - 1)];
    packet.org_x[i] = r.origin[0];
    packet.org_y[i] = r.origin[1];
    packet.org_z[i] = r.origin[2];
    packet.tnear[i] = r.tmin;
    packet.dir_x[i] = r.direction[0];
    packet.dir_y[i] = r.direction[1];
    packet.dir_z[i] = r.direction[2];
    packet.tfar[i] = r.tmax;
    packet.time[i] = 0.0F;
    packet.mask[i] = 0xffffffffU;
    packet.id[i] = 0;
    packet.flags[i] = 0;
  }
}

RTCIntersectContext coherent_context() {
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  return context;
}

}  // namespace

const char* to_string(EmbreeQuality quality) {
  switch (quality) {
    case EmbreeQuality::kLow:
      return "LOW";
    case EmbreeQuality::kMedium:
      return "MEDIUM";
    case EmbreeQuality::kHigh:
      return "HIGH";
  }
  return "?";
}

EmbreeScene::EmbreeScene(std::span<const GnTriangle> triangles, EmbreeQuality quality, bool robust,
                         unsigned threads)
    : triangles_(triangles), quality_(quality), robust_(robust), threads_(threads) {
  device_ = rtcNewDevice(("set_affinity=0,threads=" + std::to_string(threads)).c_str());
  rtcSetDeviceMemoryMonitorFunction(
      device_,
      [](void* bytes, std::int64_t change, bool) {
        *static_cast<std::atomic<std::int64_t>*>(bytes) += change;
        return true;
      },
      &bytes_);
}

EmbreeScene::~EmbreeScene() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  rtcReleaseDevice(device_);
}

std::string EmbreeScene::name() const {
  return std::string(to_string(quality_)) + (robust_ ? " ROBUST" : "");
}

void EmbreeScene::build() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
  scene_ = rtcNewScene(device_);
  rtcSetSceneBuildQuality(scene_, rtc_quality(quality_));
  if (robust_) rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
  // A scene of low quality is built in two levels, each geometry by its own quality.
  if (quality_ == EmbreeQuality::kLow) rtcSetGeometryBuildQuality(geometry, RTC_BUILD_QUALITY_LOW);
  const std::size_t count = triangles_.size();
  auto* vertices = static_cast<float*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 12, 3 * count));
  auto* indices = static_cast<unsigned*>(
      rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 12, count));
  std::copy_n(triangles_.front().v0, 9 * count, vertices);
  for (unsigned i = 0; i < 3 * count; ++i) indices[i] = i;
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(scene_);
}

// Runs work(first, last) over all rays, in pieces whose ends are multiples of a packet, on our threads.
template <typename Work>
void EmbreeScene::share(std::size_t rays, const Work& work) const {
  if (threads_ == 1) {
    work(std::size_t{0}, rays);
    return;
  }
  const std::size_t piece = (rays / threads_ / kPacket + 1) * kPacket;
  std::vector<std::thread> threads;
  for (std::size_t first = 0; first < rays; first += piece)
    threads.emplace_back([&work, first, last = std::min(rays, first + piece)] { work(first, last); });
  for (std::thread& thread : threads) thread.join();
}

void EmbreeScene::closest(std::span<const Ray> rays, std::span<Hit> hits) const {
  share(rays.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      RTCRayHit query{};
      query.ray = load(rays[i]);
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      query.hit.primID = RTC_INVALID_GEOMETRY_ID;
      rtcIntersect1(scene_, &context, &query);
      hits[i] = {query.ray.tfar, query.hit.u, query.hit.v, query.hit.primID};
    }
  });
}

void EmbreeScene::any(std::span<const Ray> rays, std::span<std::uint32_t> occluded) const {
  share(rays.size(), [&](std::size_t first, std::size_t last) {
    for (std::size_t i = first; i < last; ++i) {
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      RTCRay ray = load(rays[i]);
      rtcOccluded1(scene_, &context, &ray);
      occluded[i] = ray.tfar < 0.0F ? 1 : 0;
    }
  });
}

void EmbreeScene::closest16(std::span<const Ray> rays, std::span<Hit> hits) const {
  share(rays.size(), [&](std::size_t first, std::size_t last) {
    alignas(64) int valid[kPacket];
    RTCRayHit16 query;
    for (std::size_t i = first; i < last; i += kPacket) {
      RTCIntersectContext context = coherent_context();
      load16(rays, i, query.ray, valid);
      std::fill_n(query.hit.geomID, kPacket, RTC_INVALID_GEOMETRY_ID);
      std::fill_n(query.hit.primID, kPacket, RTC_INVALID_GEOMETRY_ID);
      rtcIntersect16(valid, scene_, &context, &query);
      for (std::size_t k = 0; k < kPacket && i + k < last; ++k)
        hits[i + k] = {query.ray.tfar[k], query.hit.u[k], query.hit.v[k], query.hit.primID[k]};
    }
  });
}

void EmbreeScene::any16(std::span<const Ray> rays, std::span<std::uint32_t> occluded) const {
  share(rays.size(), [&](std::size_t first, std::size_t last) {
    alignas(64) int valid[kPacket];
    RTCRay16 packet;
    for (std::size_t i = first; i < last; i += kPacket) {
      RTCIntersectContext context = coherent_context();
      load16(rays, i, packet, valid);
      rtcOccluded16(valid, scene_, &context, &packet);
      for (std::size_t k = 0; k < kPacket && i + k < last; ++k)
        occluded[i + k] = packet.tfar[k] < 0.0F ? 1 : 0;
    }
  });
}

}  // namespace gnomon::peers
