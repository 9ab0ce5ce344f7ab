// The program's exit statuses, as --help lists them. Feeds main and `validate`.
#pragma once

namespace gnomon::app {

enum ExitStatus : int {
  kOk = 0,
  kFailure = 1,
  kUsage = 2,
  kNoDevice = 3,
  kBadScene = 4,
  kOutOfMemory = 5,
  kMismatch = 6,
  kMoved = 7,
  kInterrupted = 130,  // 128 + SIGINT, as shells count
};

}  // namespace gnomon::app
