#include "gnomon/device/find_areas.h"

#include "gnomon/cl/launch.h"
#include "gnomon/cl/program.h"
#include "gnomon/device/ray_batches.h"

namespace gnomon {
namespace {

// A candidate costs a turn of the lookup's loop and at most six of the planes', for up to 16 rays side by
// side; the rest is for the walk.
constexpr std::uint32_t kTurnsPerArea = 512;

constexpr std::size_t kGroup = 64;

template <typename T>
cl::Buffer buffer_of(const cl::Context& context, const char* name, std::span<const T> values) {
  cl::Buffer buffer = context.create_buffer(name, values.size_bytes());
  context.upload_values<T>(buffer, values);
  return buffer;
}

}  // namespace

std::uint64_t DeviceTopLevel::bytes() const {
  return areas.bytes + boxes.bytes + cells.bytes + cell_areas.bytes;
}

std::string DeviceTopLevel::program_options() const {
  return "-DGN_LOOKUP=" + std::to_string(static_cast<std::uint32_t>(lookup));
}

DeviceTopLevel upload_top_level(const cl::Context& context, const TopLevel& top_level,
                                std::span<const GnArea> areas) {
  if (top_level.area_count != areas.size()) {
    throw Error(ErrorCode::kInvalidArgument, "a top level of " + std::to_string(top_level.area_count) +
                                                 " areas does not fit " + std::to_string(areas.size()));
  }
  const std::uint32_t loop_limit = context.device().loop_limit;
  if (loop_limit != 0 && areas.size() > loop_limit / kTurnsPerArea) {
    throw Error(ErrorCode::kDevice, context.device().name + " ends long loops, so it can look up at most " +
                                        std::to_string(loop_limit / kTurnsPerArea) + " areas, not " +
                                        std::to_string(areas.size()) + "; use another device");
  }
  DeviceTopLevel out;
  out.areas = buffer_of(context, "areas", areas);
  out.boxes = buffer_of<GnAreaBox>(context, "area_boxes", top_level.boxes);
  out.cells = buffer_of<GnAreaCell>(context, "area_cells", top_level.cells);
  out.cell_areas = buffer_of<std::uint32_t>(context, "cell_areas", top_level.cell_areas);
  out.box_count = static_cast<std::uint32_t>(top_level.boxes.size());
  out.area_count = top_level.area_count;
  out.lookup = top_level.lookup;
  return out;
}

AreaFinder::AreaFinder(const cl::Context& context, const DeviceTopLevel& top_level)
    : context_(context), top_level_(top_level) {
  const std::string options = top_level.program_options();
  choose_ = context.programs().kernel({"find_areas.cl"}, options, "choose_areas");
  count_ = context.programs().kernel({"find_areas.cl"}, options, "count_areas");
}

double AreaFinder::run(const cl::Handle<cl_kernel>& kernel, std::size_t rays) const {
  cl::set_arguments(kernel.get(), top_level_.areas, top_level_.boxes, top_level_.cells, top_level_.cell_areas,
                    top_level_.box_count);
  const std::size_t local = std::min<std::size_t>(kGroup, context_.device().max_work_group);
  const auto event = cl::enqueue(context_.queue(), kernel.get(), (rays + local - 1) / local * local, local);
  cl::wait(event);
  return event_ms(event);
}

AreaFinder::Chosen AreaFinder::choose(std::span<const Ray> rays) const {
  Chosen out;
  if (rays.empty()) return out;
  const cl::Buffer in = buffer_of(context_, "rays", rays);
  const cl::Buffer chosen = context_.create_buffer("chosen", rays.size() * sizeof(std::uint32_t));
  cl::set_arguments_from(choose_.get(), 5, in, chosen, static_cast<std::uint32_t>(rays.size()));
  out.kernel_ms = run(choose_, rays.size());
  out.areas = context_.download_values<std::uint32_t>(chosen, rays.size());
  return out;
}

AreaFinder::Counted AreaFinder::count(std::span<const Ray> rays) const {
  Counted out;
  if (rays.empty()) return out;
  const cl::Buffer in = buffer_of(context_, "rays", rays);
  const cl::Buffer offered = context_.create_buffer("offered", rays.size() * sizeof(std::uint32_t));
  const cl::Buffer holding = context_.create_buffer("holding", rays.size() * sizeof(std::uint32_t));
  cl::set_arguments_from(count_.get(), 5, in, offered, holding, static_cast<std::uint32_t>(rays.size()));
  out.kernel_ms = run(count_, rays.size());
  out.offered = context_.download_values<std::uint32_t>(offered, rays.size());
  out.holding = context_.download_values<std::uint32_t>(holding, rays.size());
  return out;
}

}  // namespace gnomon
