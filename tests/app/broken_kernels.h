// Faults planted in kernels: what checks of hits and trees must see. Feeds the tests of `validate` and
// `stability`.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "run_program.h"

namespace program {

struct Edit {
  std::string file, right, wrong;
};

// A copy of the kernels with some of their text replaced. Text that is no longer there fails the test: then
// the fault has to be planted anew.
class BrokenKernels {
 public:
  explicit BrokenKernels(const std::vector<Edit>& edits) {
    std::filesystem::copy(GNOMON_KERNEL_FOLDER, kernels_, std::filesystem::copy_options::recursive);
    for (const Edit& edit : edits) {
      std::string text = program::read_text(kernels_ / edit.file);
      const auto at = text.find(edit.right);
      CAPTURE(edit.file, edit.right);
      REQUIRE(at != std::string::npos);
      program::write_text(kernels_ / edit.file, text.replace(at, edit.right.size(), edit.wrong));
    }
  }
  [[nodiscard]] program::Setup setup() const {
    return {{{"GNOMON_KERNELS", kernels_.string()}}, false, {}, {}};
  }

 private:
  Folder folder_;
  std::filesystem::path kernels_ = folder_.path() / "kernels";
};

}  // namespace program
