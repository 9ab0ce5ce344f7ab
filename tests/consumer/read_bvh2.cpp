// Reads a plain tree (gnomon build SCENE -o tree.bvh2) and traces a ray through it, without gnomon. The
// file's layout is in host/notes/tree-file.md. Its triangle test is the textbook's (Moeller, Trumbore 1997),
// not gnomon's exact one.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <vector>

struct Vec {
  float x, y, z;
};
struct Node {
  float lo[3];
  std::uint32_t left_first;
  float hi[3];
  std::uint32_t count;
};
struct Triangle {
  Vec a, b, c;
};
static Vec sub(Vec a, Vec b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
static float dot(Vec a, Vec b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
static Vec cross(Vec a, Vec b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

int main(int argc, char** argv) {
  std::ifstream in(argc > 1 ? argv[1] : "city.bvh2", std::ios::binary);
  const std::vector<char> bytes(std::istreambuf_iterator<char>(in), {});
  if (bytes.size() < 32) return std::puts("no such tree"), 1;
  const auto* head =
      reinterpret_cast<const std::uint32_t*>(bytes.data() + 8);  // version, nodes, indices, ...
  const auto* nodes = reinterpret_cast<const Node*>(bytes.data() + 32);
  const auto* indices = reinterpret_cast<const std::uint32_t*>(nodes + head[1]);
  const auto* triangles = reinterpret_cast<const Triangle*>(indices + head[2]);

  const float origin[3] = {0.5F * (nodes->lo[0] + nodes->hi[0]), nodes->hi[1] + 1,
                           0.5F * (nodes->lo[2] + nodes->hi[2])};
  const float way[3] = {1e-3F, -1, 2e-3F};  // down on the scene's middle
  float nearest = INFINITY;
  std::uint32_t hit = UINT32_MAX;
  for (std::vector<std::uint32_t> open{0}; !open.empty();) {
    const Node& node = nodes[open.back()];
    open.pop_back();
    float enter = 0, leave = nearest;
    for (int k = 0; k < 3; ++k) {
      const float s = (node.lo[k] - origin[k]) / way[k], t = (node.hi[k] - origin[k]) / way[k];
      enter = std::max(enter, std::min(s, t)), leave = std::min(leave, std::max(s, t));
    }
    if (enter > leave) continue;
    if (node.count == 0) open.insert(open.end(), {node.left_first, node.left_first + 1});
    for (std::uint32_t i = 0; i < node.count; ++i) {
      const Triangle& tri = triangles[indices[node.left_first + i]];
      const Vec d{way[0], way[1], way[2]}, e = sub(tri.b, tri.a), f = sub(tri.c, tri.a), p = cross(d, f);
      const Vec s = sub({origin[0], origin[1], origin[2]}, tri.a), q = cross(s, e);
      const float scale = 1 / dot(e, p), u = dot(s, p) * scale, v = dot(d, q) * scale, t = dot(f, q) * scale;
      if (u >= 0 && v >= 0 && u + v <= 1 && t > 0 && t < nearest)
        nearest = t, hit = indices[node.left_first + i];
    }
  }
  std::printf("%u nodes over %u triangles; the ray down hits triangle %u at %g\n", head[1], head[3], hit,
              nearest);
  return hit == UINT32_MAX ? 1 : 0;
}
