// Every kind of measure over seeded boxes: the device's bits are the host's. Small enough for a device that
// ends long loops and for the simulator, which cannot build trees with these measures.
#include <catch2/catch.hpp>
#include <cmath>

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/shared/measure_math.h"
#include "support/device.h"
#include "support/measures.h"
#include "support/shapes.h"

namespace cl = gnomon::cl;
using gnomon::test::context;
using gnomon::test::Random;

namespace {

template <typename T>
cl::Buffer buffer_of(const char* name, const std::vector<T>& values) {
  cl::Buffer buffer = context().create_buffer(name, values.size() * sizeof(T));
  context().upload_values<T>(buffer, values);
  return buffer;
}

// Boxes about the cube of side 10, from specks to ones around everything; every eighth is flat.
std::vector<float> seeded_boxes(std::uint32_t count) {
  Random random(111);
  std::vector<float> boxes;
  for (std::uint32_t i = 0; i < count; ++i) {
    const float size = 0.02F * std::pow(1500.0F, random.between(0, 1));
    float lo[3], hi[3];
    for (std::size_t k = 0; k < 3; ++k) {
      lo[k] = random.between(-4, 12);
      hi[k] = i % 8 == k ? lo[k] : lo[k] + size * random.between(0.05F, 1);
    }
    boxes.insert(boxes.end(), lo, lo + 3);
    boxes.insert(boxes.end(), hi, hi + 3);
  }
  return boxes;
}

// The test measures and some more: not cut to a window, beginning behind an eye of a tilted frame, a window
// of rays from far away.
std::vector<GnMeasure> probed_measures() {
  std::vector<GnMeasure> out;
  for (const auto& [name, measure] : gnomon::test::every_measure()) out.push_back(measure);
  GnMeasure whole = gnomon::test::framed(GN_MEASURE_NEAR_PLANE, {2, 4, -3}, 0, 0);
  whole.near_distance = 0.25F;
  out.push_back(whole);
  GnMeasure wide = gnomon::test::framed(GN_MEASURE_YAW_PITCH, {5, 5, 5}, 4.0F, 3.0F);
  wide.culled = 1;
  wide.near_distance = 0.01F;
  wide.half_pitch = 1.2490458F;  // atan 3
  out.push_back(wide);
  // A small window of parallel rays that begin before every box.
  GnMeasure narrow = gnomon::test::framed(GN_MEASURE_WINDOW, {4, 5, 3}, 2.5F, 1.5F);
  narrow.culled = 1;
  narrow.near_distance = -60;
  out.push_back(narrow);
  return out;
}

constexpr std::uint32_t kManyBoxes = 240;
constexpr std::uint32_t kFewBoxes = 16;  // for the simulator, which takes its time

// options: of the kernel's compiler.
void require_host_bits(const char* options, std::uint32_t box_count) {
  const std::vector<GnMeasure> measures = probed_measures();
  const std::vector<float> boxes = seeded_boxes(box_count);
  const std::size_t items = measures.size() * box_count;
  const cl::Buffer measure_buffer = buffer_of("measures", measures);
  const cl::Buffer box_buffer = buffer_of("boxes", boxes);
  const cl::Buffer how = context().create_buffer("how", items * sizeof(std::uint32_t));
  const cl::Buffer chosen = context().create_buffer("chosen", items * sizeof(float));
  const cl::Buffer precise = context().create_buffer("precise", items * sizeof(float));
  const auto kernel = context().programs().kernel({"probe_measures.cl"}, options, "probe_measures");
  cl::set_arguments(kernel.get(), measure_buffer, box_buffer, box_count, how, chosen, precise);
  cl::wait(cl::enqueue(context().queue(), kernel.get(), items, 0));
  const auto got_how = context().download_values<std::uint32_t>(how, items);
  const auto got_chosen = context().download_values<float>(chosen, items);
  const auto got_precise = context().download_values<float>(precise, items);
  std::vector<std::size_t> seen(6);
  std::size_t positive = 0;
  for (std::size_t i = 0; i < items; ++i) {
    const GnMeasure& measure = measures[i / box_count];
    const float* const lo = &boxes[6 * (i % box_count)];
    const float* const hi = lo + 3;
    const int expected = gn_measure_how(&measure, lo, hi);
    CAPTURE(i / box_count, i % box_count, measure.kind, expected);
    REQUIRE(got_how[i] == static_cast<std::uint32_t>(expected));
    REQUIRE(gn_bits_of(got_chosen[i]) == gn_bits_of(gn_box_measure(&measure, expected, lo, hi)));
    REQUIRE(gn_bits_of(got_precise[i]) == gn_bits_of(gn_box_measure(&measure, GN_SEEN_PRECISE, lo, hi)));
    seen.at(static_cast<std::size_t>(expected)) += 1;
    positive += got_precise[i] > 0.0F ? 1 : 0;
  }
  for (const std::size_t count : seen) REQUIRE(8 * count >= box_count);  // each way of weighing was met
  REQUIRE(positive > items / 2);
}

}  // namespace

TEST_CASE("every measure of a box has the host's bits on the device", "[portable]") {
  require_host_bits("", kManyBoxes);
}

// Devices that end long loops take none but linear measures in lanes, which their trees show.
TEST_CASE("every measure of a box has the host's bits in four lanes too", "[portable][unlimited]") {
  require_host_bits("-DGN_WGS=1", kManyBoxes);
}

TEST_CASE("measures of a few boxes keep to their buffers", "[memcheck]") {
  require_host_bits("", kFewBoxes);
  require_host_bits("-DGN_WGS=1", kFewBoxes);
}
