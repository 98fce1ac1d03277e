#include "row_request.hpp"

#include <algorithm>
#include <cerrno>

#include "gravure/core/file_output.hpp"

namespace gravure::oiio {

std::string place_of(const ImageInfo& info) {
  return info.path + ": page " + std::to_string(info.page) + ": ";
}

Result<void> check_rows(const ImageInfo& info, std::int64_t first_row, std::int64_t row_count, std::size_t out_bytes) {
  if (first_row < 0 || row_count < 0 || row_count > info.height || first_row > info.height - row_count) {
    return Error{ErrorCode::out_of_range, place_of(info) + "rows " + std::to_string(first_row) + " + " +
                                              std::to_string(row_count) + " asked for: it has rows 0 to " +
                                              std::to_string(info.height - 1)};
  }
  const std::int64_t needed = row_count * row_bytes(info.samples, info.width);
  if (out_bytes < static_cast<std::size_t>(needed)) {
    return Error{ErrorCode::bad_argument, place_of(info) + "the buffer for " + std::to_string(row_count) +
                                              " rows holds " + std::to_string(out_bytes) + " bytes, " +
                                              std::to_string(needed) + " are needed"};
  }
  return {};
}

Error damaged_rows(const ImageInfo& info, std::int64_t first_row, std::int64_t row_count, std::string reason) {
  if (const int failure = errno; is_device_failure(failure)) {
    return read_error(place_of(info) + "row " + std::to_string(first_row), failure);
  }
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  const std::string rows =
      std::to_string(first_row) + (row_count > 1 ? " to " + std::to_string(first_row + row_count - 1) : "");
  return {ErrorCode::bad_file, place_of(info) + "row " + rows +
                                   ": the image data are damaged or truncated; copy or export the file again" +
                                   (reason.empty() ? "" : " (" + reason + ")")};
}

}  // namespace gravure::oiio
