// The one exception type of the library. Not for caller bugs (those are asserts) and not for expected absence
// (std::optional). Feeds every room; the command line turns a code into an exit status.
#pragma once

#include <stdexcept>
#include <string>

namespace gnomon {

// What went wrong, coarse enough to act on.
enum class ErrorCode {
  kInvalidArgument,  // an option or argument out of its documented range
  kIo,               // a file that cannot be opened, read or written
  kNoDevice,         // no OpenCL platform or device, or an unknown choice of one
  kBadScene,         // input that is not a scene we can trace, or not a tree of it
  kOutOfMemory,      // a buffer that does not fit; the message names it and its size
  kDevice,           // an OpenCL call or a kernel build failed; the message carries the log
  kCancelled,        // the caller's progress function asked to stop
};

// An error with its place: message() says what, where and, when there is one, what to do next.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  [[nodiscard]] ErrorCode code() const { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace gnomon
