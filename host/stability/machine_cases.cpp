// Machines that are hard: work-groups of any size, little memory, caches that are cold or damaged, another
// device. The tree must be the same to the last byte, the hits the oracle's. Devices that fail are simulated
// in the tests (tests/faults), where calls can be made to.
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "gnomon/stability/aim.h"
#include "gnomon/stability/cases.h"

namespace gnomon::stability {

namespace {

// What a machine must give, by each builder: the bench's own.
struct Expected {
  Specimen specimen;
  std::vector<std::string> hashes;  // of the builders' trees
  std::vector<Hit> hits;
};

Expected expected_of(const Bench& bench) {
  Expected out{soup_and_hill(bench, 700), {}, {}};
  for (const Builder& builder : bench.builders) {
    const DeviceBvh tree = build_device(bench.context, out.specimen.triangles, builder.options);
    out.hashes.push_back(tree_hash(download_bvh(bench.context, tree)));
    out.hits = Tracer(bench.context, tree).closest(out.specimen.rays).hits;
  }
  return out;
}

bool same_hits(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Hit)) == 0;
}

// Builds and traces on a context, holds tree and hits against the expected, and has them judged. `same`: hits
// too must be the same bits.
void check_machine(const cl::Context& context, const Expected& expected, const Builder& builder,
                   const std::string& hash, const TraceOptions& trace, bool same, const std::string& where,
                   Verdict& verdict) {
  const Specimen& specimen = expected.specimen;
  const DeviceBvh tree = build_device(context, specimen.triangles, builder.options);
  if (tree_hash(download_bvh(context, tree)) != hash) verdict.fault("another tree " + where);
  const Tracer tracer(context, tree, trace);
  const TraceResult closest = tracer.closest(specimen.rays);
  const TraceResult any = tracer.any(specimen.rays);
  if (same && !same_hits(closest.hits, expected.hits)) verdict.fault("other hits " + where);
  judge_answers(specimen, closest.hits, any.occluded, closest.invalid_rays, verdict);
}

std::vector<Verdict> work_groups(const Bench& bench, const CaseInfo& info) {
  const Expected expected = expected_of(bench);
  std::vector<Verdict> all;
  for (std::size_t b = 0; b < bench.builders.size(); ++b) {
    for (const Flavour& flavour : bench.flavours) {
      Verdict verdict = empty_verdict(bench, info, bench.builders[b].name, flavour.name);
      for (const std::uint32_t size : {1U, 2U, 16U, 128U}) {
        if (size > bench.context.device().max_work_group) continue;
        Builder builder = bench.builders[b];
        builder.options.work_group_size = size;  // 1: a serial device
        builder.options.subtree_size = 32 * size;
        builder.options.chunk_size = 64 * size;
        TraceOptions trace = flavour.options;
        trace.work_group_size = size;
        check_machine(bench.context, expected, builder, expected.hashes[b], trace, true,
                      "in groups of " + std::to_string(size), verdict);
      }
      all.push_back(verdict);
    }
  }
  return all;
}

// The largest buffer just fits, and just does not.
std::vector<Verdict> little_memory(const Bench& bench, const CaseInfo& info) {
  const Expected expected = expected_of(bench);
  std::vector<Verdict> all;
  for (std::size_t b = 0; b < bench.builders.size(); ++b) {
    const Builder& builder = bench.builders[b];
    Verdict verdict = empty_verdict(bench, info, builder.name, "-");
    cl::DeviceInfo device = bench.context.device();
    std::uint64_t largest = 0;
    for (const BufferNeed& need : build_memory(
             device, static_cast<std::uint32_t>(expected.specimen.triangles.size()), builder.options))
      largest = std::max(largest, need.bytes);
    device.max_allocation = largest;
    TraceOptions thread;  // the other flavours need buffers of their own
    thread.flavour = TraceFlavour::kThread;
    check_machine(cl::Context(device), expected, builder, expected.hashes[b], thread, true,
                  "where the largest buffer just fits", verdict);
    device.max_allocation = largest - 1;
    try {
      static_cast<void>(build_device(cl::Context(device), expected.specimen.triangles, builder.options));
      verdict.fault("a build that does not fit is not refused");
    } catch (const Error& error) {
      if (error.code() != ErrorCode::kOutOfMemory)
        verdict.fault("a build that does not fit fails with: " + std::string(error.what()));
    }
    all.push_back(verdict);
  }
  return all;
}

// A folder of its own, gone afterwards.
class ScratchFolder {
 public:
  ScratchFolder()
      : path_(std::filesystem::temp_directory_path() / ("gnomon-stability-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

// Cold, then as it was left, then every entry with bytes changed in its middle, then cut short.
std::vector<Verdict> caches(const Bench& bench, const CaseInfo& info) {
  const Expected expected = expected_of(bench);
  Verdict verdict = empty_verdict(bench, info, bench.builders[0].name, bench.flavours[0].name);
  const ScratchFolder folder;
  for (const char* const state : {"cold", "warm", "damaged", "cut short"}) {
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      const auto size = std::filesystem::file_size(entry.path());
      if (std::strcmp(state, "damaged") == 0) {
        std::fstream file(entry.path(), std::ios::in | std::ios::out | std::ios::binary);
        file.seekp(static_cast<std::streamoff>(size / 2));
        file.write("damaged!", 8);
      } else if (std::strcmp(state, "cut short") == 0) {
        std::filesystem::resize_file(entry.path(), size / 3);
      }
    }
    cl::ContextOptions options;
    options.cache_folder = folder.path();
    check_machine(cl::Context(bench.context.device(), options), expected, bench.builders[0],
                  expected.hashes[0], bench.flavours[0].options, true,
                  std::string("with a cache that is ") + state, verdict);
  }
  return {verdict};
}

// Every other device there is; without double there, hits may differ, and the oracle judges alone.
std::vector<Verdict> other_devices(const Bench& bench, const CaseInfo& info) {
  const Expected expected = expected_of(bench);
  std::vector<Verdict> all;
  for (const cl::DeviceInfo& device : cl::list_devices()) {
    if (!device.available || device.device == bench.context.device().device) continue;
    const cl::Context context(device);
    for (std::size_t b = 0; b < bench.builders.size(); ++b) {
      Verdict verdict = empty_verdict(bench, info, bench.builders[b].name, device.name);
      verdict.exact = device.fp64;
      verdict.most_ulp = device.fp64 ? kMostUlp : std::numeric_limits<double>::infinity();
      check_machine(context, expected, bench.builders[b], expected.hashes[b], {},
                    device.fp64 && bench.context.device().fp64, "on " + device.name, verdict);
      all.push_back(verdict);
    }
  }
  return all;
}

}  // namespace

void add_machine_cases(std::vector<Case>& cases) {
  const auto add = [&](std::uint32_t number, const char* name, const char* expectation,
                       std::function<std::vector<Verdict>(const Bench&, const CaseInfo&)> check) {
    cases.push_back({{number, "machines", name, expectation}, {}, std::move(check)});
  };
  add(61, "work-groups of 1 to 128, small subtrees and chunks", "the same tree and hits, bit for bit",
      work_groups);
  add(62, "memory that just fits, and just does not", "the same tree and hits, or a refusal", little_memory);
  add(63, "caches that are cold, warm, damaged and cut short", "the same tree and hits, bit for bit", caches);
  add(64, "every other device", "the same tree; the same hits where both have double", other_devices);
}

}  // namespace gnomon::stability
