#include "version.h"

#include "gnomon_commit.h"

namespace gnomon::app {

std::string version() {
  return GNOMON_VERSION;
}
std::string commit() {
  return GNOMON_COMMIT;
}

}  // namespace gnomon::app
