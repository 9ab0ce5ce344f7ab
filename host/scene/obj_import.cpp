#include <utility>

#include "gnomon/scene/import.h"
#include "gnomon/scene/import_message.h"
#include "gnomon/scene/obj_reader.h"
#include "gnomon/scene/read_file.h"

namespace gnomon {

Scene import_obj(const std::filesystem::path& file, const ImportOptions& options) {
  auto text = read_file(file);
  return run_import(file, [&] {
    Scene scene = import_obj_bytes(std::move(text), file.parent_path(), options);
    scene.name = file.stem().string();
    return scene;
  });
}

}  // namespace gnomon
