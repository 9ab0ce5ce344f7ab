#include "gnomon/cl/program.h"

#define XXH_INLINE_ALL
#include <unistd.h>
#include <xxhash.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <set>

#include "gnomon/base/error.h"
#include "gnomon/cl/check.h"

namespace gnomon::cl {

namespace {

// Changes whenever the meaning of a cache entry does.
constexpr std::string_view kCacheFormat = "gnomon-program-1";

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

std::uint64_t hash_of(std::string_view text) {
  return XXH3_64bits(text.data(), text.size());
}

std::string read_kernel(std::string_view path) {
  if (const char* folder = std::getenv("GNOMON_KERNELS"); folder != nullptr && *folder != '\0') {
    const auto file = std::filesystem::path(folder) / path;
    std::ifstream in(file, std::ios::binary);
    if (!in)
      throw Error(ErrorCode::kIo, "cannot read kernel source " + file.string() + " (GNOMON_KERNELS is set)");
    return {std::istreambuf_iterator<char>(in), {}};
  }
  for (const EmbeddedFile& file : embedded_kernels()) {
    if (file.path == path) return std::string(file.text);
  }
  throw Error(ErrorCode::kIo, "no kernel source named " + std::string(path));
}

// Includes are written relative to kernels/ or, inside kernels/shared, to that folder.
std::string resolve_include(std::string_view includer, const std::string& name) {
  const auto slash = includer.rfind('/');
  return slash == std::string_view::npos ? name : std::string(includer.substr(0, slash + 1)) + name;
}

void append_flat(std::string_view path, std::set<std::string>& seen, std::string& out) {
  if (!seen.insert(std::string(path)).second) return;
  const std::string text = read_kernel(path);
  out += "#line 1 \"" + std::string(path) + "\"\n";
  std::size_t line_number = 1;
  for (std::size_t at = 0; at < text.size(); ++line_number) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    const std::string_view line = std::string_view(text).substr(at, end - at);
    constexpr std::string_view kInclude = "#include \"";
    if (line.starts_with(kInclude)) {
      const auto close = line.find('"', kInclude.size());
      const std::string name(line.substr(kInclude.size(), close - kInclude.size()));
      append_flat(resolve_include(path, name), seen, out);
      out += "#line " + std::to_string(line_number + 1) + " \"" + std::string(path) + "\"\n";
    } else {
      out += line;
      out += '\n';
    }
    at = end + 1;
  }
}

std::string flatten_all(const std::vector<std::string>& files) {
  std::set<std::string> seen;
  std::string out;
  for (const std::string& file : files) append_flat(file, seen, out);
  return out;
}

// A cache file: format line, payload hash line, payload.
std::optional<std::string> read_entry(const std::filesystem::path& entry) {
  std::ifstream in(entry, std::ios::binary);
  std::string format, hash;
  if (!std::getline(in, format) || !std::getline(in, hash) || format != kCacheFormat) return std::nullopt;
  std::string payload{std::istreambuf_iterator<char>(in), {}};
  if (payload.empty() || hash != hex(hash_of(payload))) return std::nullopt;
  return payload;
}

}  // namespace

std::string flatten_kernel(std::string_view path) {
  return flatten_all({std::string(path)});
}

std::filesystem::path default_cache_folder() {
  if (const char* xdg = std::getenv("XDG_CACHE_HOME"); xdg != nullptr && *xdg == '/') {
    return std::filesystem::path(xdg) / "gnomon";
  }
  if (const char* home = std::getenv("HOME"); home != nullptr && *home == '/') {
    return std::filesystem::path(home) / ".cache" / "gnomon";
  }
  return {};
}

ProgramStore::ProgramStore(cl_context context, const DeviceInfo& device, const ContextOptions& options)
    : context_(context), device_(device) {
  if (!options.use_cache) return;
  // Asked for a program's binary, PoCL compiles each of its kernels twice, for any work-group size, and then
  // once more for the size that is launched.
  if (options.cache_folder) {
    cache_folder_ = *options.cache_folder;
  } else if (!device.keeps_programs) {
    cache_folder_ = default_cache_folder();
  }
}

cl_program ProgramStore::get(const std::vector<std::string>& files, const std::string& options) {
  // Putting sources together takes longer than many a launch. Files of a folder may change, embedded ones do
  // not.
  std::string request = options;
  for (const std::string& file : files) request += '\n' + file;
  const bool embedded = std::getenv("GNOMON_KERNELS") == nullptr;
  if (const auto known = asked_for_.find(request); embedded && known != asked_for_.end())
    return known->second;
  cl_program const program = put_together(files, options);
  if (embedded) asked_for_.insert_or_assign(request, program);
  return program;
}

cl_program ProgramStore::put_together(const std::vector<std::string>& files, const std::string& options) {
  const std::string all_options = "-cl-std=CL1.2 " + options;
  const std::string source = flatten_all(files);
  std::string key(kCacheFormat);
  for (const std::string& part :
       {source, all_options, device_.name, device_.platform_name, device_.version, device_.driver}) {
    key += '\n' + hex(hash_of(part));
  }
  const std::string name = hex(hash_of(key));
  if (const auto found = programs_.find(name); found != programs_.end()) return found->second.get();
  const auto entry = cache_folder_.empty() ? std::filesystem::path{} : cache_folder_ / (name + ".clbin");
  Handle<cl_program> program = load_binary(entry, all_options);
  if (!program) {
    program = compile(source, all_options);
    save_binary(entry, program.get());
  }
  return programs_.emplace(name, std::move(program)).first->second.get();
}

Handle<cl_kernel> ProgramStore::kernel(const std::vector<std::string>& files, const std::string& options,
                                       const char* name) {
  cl_int status = CL_SUCCESS;
  Handle<cl_kernel> kernel(clCreateKernel(get(files, options), name, &status));
  check(status, "clCreateKernel", name);
  return kernel;
}

Handle<cl_program> ProgramStore::load_binary(const std::filesystem::path& entry, const std::string& options) {
  std::error_code ignored;
  if (entry.empty() || !std::filesystem::exists(entry, ignored)) return {};
  const auto payload = read_entry(entry);
  if (payload) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(payload->data());
    const std::size_t size = payload->size();
    cl_int binary_status = CL_SUCCESS;
    cl_int status = CL_SUCCESS;
    Handle<cl_program> program(
        clCreateProgramWithBinary(context_, 1, &device_.device, &size, &bytes, &binary_status, &status));
    if (status == CL_SUCCESS && binary_status == CL_SUCCESS &&
        clBuildProgram(program.get(), 1, &device_.device, options.c_str(), nullptr, nullptr) == CL_SUCCESS) {
      stats_.from_disk += 1;
      return program;
    }
  }
  stats_.rejected += 1;
  return {};
}

Handle<cl_program> ProgramStore::compile(const std::string& source, const std::string& options) {
  cl_int status = CL_SUCCESS;
  const char* text = source.c_str();
  const std::size_t size = source.size();
  Handle<cl_program> program(clCreateProgramWithSource(context_, 1, &text, &size, &status));
  check(status, "clCreateProgramWithSource");
  status = clBuildProgram(program.get(), 1, &device_.device, options.c_str(), nullptr, nullptr);
  if (status != CL_SUCCESS) {
    check(status, "clBuildProgram",
          device_.name + ", options " + options + "; build log:\n" + build_log(program.get()));
  }
  stats_.compiled += 1;
  return program;
}

void ProgramStore::save_binary(const std::filesystem::path& entry, cl_program program) const {
  if (entry.empty()) return;
  std::size_t size = 0;
  if (clGetProgramInfo(program, CL_PROGRAM_BINARY_SIZES, sizeof size, &size, nullptr) != CL_SUCCESS ||
      size == 0)
    return;
  std::string payload(size, '\0');
  auto* bytes = reinterpret_cast<unsigned char*>(payload.data());
  if (clGetProgramInfo(program, CL_PROGRAM_BINARIES, sizeof bytes, &bytes, nullptr) != CL_SUCCESS) return;
  // A cache that cannot be written is no error; a half-written entry must never appear under its name.
  std::error_code failed;
  std::filesystem::create_directories(entry.parent_path(), failed);
  const auto temporary =
      entry.parent_path() / (entry.stem().string() + "." + std::to_string(getpid()) + ".tmp");
  std::ofstream out(temporary, std::ios::binary | std::ios::trunc);
  out << kCacheFormat << '\n' << hex(hash_of(payload)) << '\n' << payload;
  out.close();
  if (out) std::filesystem::rename(temporary, entry, failed);
  if (!out || failed) std::filesystem::remove(temporary, failed);
}

std::string ProgramStore::build_log(cl_program program) const {
  std::size_t size = 0;
  if (clGetProgramBuildInfo(program, device_.device, CL_PROGRAM_BUILD_LOG, 0, nullptr, &size) != CL_SUCCESS)
    return {};
  std::string log(size, '\0');
  clGetProgramBuildInfo(program, device_.device, CL_PROGRAM_BUILD_LOG, size, log.data(), nullptr);
  while (!log.empty() && log.back() == '\0') log.pop_back();
  return log;
}

}  // namespace gnomon::cl
