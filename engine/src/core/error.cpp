#include "gravure/core/error.hpp"

namespace gravure {

std::string_view error_code_name(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::bad_argument:
      return "bad_argument";
    case ErrorCode::out_of_range:
      return "out_of_range";
    case ErrorCode::bad_file:
      return "bad_file";
    case ErrorCode::io:
      return "io";
    case ErrorCode::device:
      return "device";
    case ErrorCode::timeout:
      return "timeout";
    case ErrorCode::version_mismatch:
      return "version_mismatch";
    case ErrorCode::cancelled:
      return "cancelled";
  }
  return "unknown";
}

int exit_status(ErrorCode code) noexcept {
  switch (code) {
    case ErrorCode::bad_argument:
    case ErrorCode::out_of_range:
    case ErrorCode::bad_file:
    case ErrorCode::version_mismatch:
      return 2;
    case ErrorCode::io:
    case ErrorCode::device:
    case ErrorCode::timeout:
      return 3;
    case ErrorCode::cancelled:
      return 4;
  }
  return 2;
}

}  // namespace gravure
