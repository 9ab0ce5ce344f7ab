// Choosing a device from a list: pure text work, no OpenCL device needed.
#include <catch2/catch.hpp>

#include "gnomon/base/error.h"
#include "gnomon/cl/device.h"

using gnomon::cl::choose_device;
using gnomon::cl::DeviceInfo;

namespace {

DeviceInfo device(std::uint32_t index, std::uint32_t platform, std::uint32_t number, const char* name,
                  bool gpu) {
  DeviceInfo d;
  d.index = index;
  d.platform_index = platform;
  d.device_index = number;
  d.name = name;
  d.platform_name = "Platform " + std::to_string(platform);
  d.is_gpu = gpu;
  d.is_cpu = !gpu;
  d.available = true;
  return d;
}

// Platform 1 has no devices, as ICD loaders often show.
std::vector<DeviceInfo> some_devices() {
  return {device(0, 0, 0, "Simple CPU", false), device(1, 2, 0, "Grand GPU 100", true),
          device(2, 2, 1, "Grand GPU 200", true)};
}

}  // namespace

TEST_CASE("without a choice the first GPU is taken, else the first CPU") {
  auto devices = some_devices();
  REQUIRE(choose_device(devices, "").name == "Grand GPU 100");
  devices[1].available = false;
  REQUIRE(choose_device(devices, "").name == "Grand GPU 200");
  devices.resize(1);
  REQUIRE(choose_device(devices, "").name == "Simple CPU");
}

TEST_CASE("a device is addressed by index, platform:device, kind or a piece of its name") {
  const auto devices = some_devices();
  REQUIRE(choose_device(devices, "2").name == "Grand GPU 200");
  REQUIRE(choose_device(devices, "2:1").name == "Grand GPU 200");
  REQUIRE(choose_device(devices, "0:0").name == "Simple CPU");
  REQUIRE(choose_device(devices, "cpu").name == "Simple CPU");
  REQUIRE(choose_device(devices, "GPU").name == "Grand GPU 100");
  REQUIRE(choose_device(devices, "gpu 200").name == "Grand GPU 200");
  REQUIRE(choose_device(devices, "simple").name == "Simple CPU");
  REQUIRE(choose_device(devices, "platform 2").name == "Grand GPU 100");
}

TEST_CASE("an unknown choice is an error that prints the list") {
  const auto devices = some_devices();
  for (const char* choice : {"3", "1:0", "2:2", "radish", "-1", "0:"}) {
    CAPTURE(choice);
    REQUIRE_THROWS_WITH(choose_device(devices, choice),
                        Catch::Contains("Simple CPU") && Catch::Contains("2:1") && Catch::Contains(choice));
  }
}

TEST_CASE("no device at all is an error that says what to install") {
  try {
    const auto unused = choose_device({}, "");
    FAIL("chose " << unused.name);
  } catch (const gnomon::Error& error) {
    REQUIRE(error.code() == gnomon::ErrorCode::kNoDevice);
    REQUIRE(std::string(error.what()).find("pocl-opencl-icd") != std::string::npos);
  }
}
