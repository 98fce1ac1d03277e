#include "tiff_handle.hpp"

#include <cstdarg>
#include <cstdio>
#include <cstring>

namespace gravure {
namespace {

/// No honest directory needs more in one piece; a tiny file that claims more is refused by libtiff before it allocates.
constexpr tmsize_t kMaxSingleAllocation = tmsize_t{512} << 20;

void keep_first(std::array<char, 256>& kept, const char* format, va_list arguments) {
  if (kept[0] == '\0') {
    std::vsnprintf(kept.data(), kept.size(), format, arguments);
  }
}

int on_error(TIFF* /*tiff*/, void* user_data, const char* /*module*/, const char* format, va_list arguments) {
  keep_first(static_cast<TiffMessages*>(user_data)->error, format, arguments);
  return 1;  // handled: the global handlers, which print, are not called
}

int on_warning(TIFF* /*tiff*/, void* user_data, const char* /*module*/, const char* format, va_list arguments) {
  auto& messages = *static_cast<TiffMessages*>(user_data);
  if (std::strstr(format, "StripByteCounts") != nullptr) {
    (std::strstr(format, "missing") != nullptr ? messages.sizes_missing : messages.sizes_wrong) = true;
  }
  // Says something of the writer's age, nothing of the data.
  if (std::strstr(format, "ld-style LZW") == nullptr) {
    keep_first(messages.warning, format, arguments);
  }
  return 1;
}

struct FreeOptions {
  void operator()(TIFFOpenOptions* options) const noexcept { TIFFOpenOptionsFree(options); }
};

}  // namespace

std::string TiffMessages::text() const {
  if (!any()) {
    return {};
  }
  return std::string(" (libtiff: ") + (error[0] != '\0' ? error.data() : warning.data()) + ")";
}

TiffHandle::TiffHandle(const std::string& path, const char* mode) : messages_(std::make_unique<TiffMessages>()) {
  const std::unique_ptr<TIFFOpenOptions, FreeOptions> options(TIFFOpenOptionsAlloc());
  if (options == nullptr) {
    throw std::bad_alloc();
  }
  TIFFOpenOptionsSetMaxSingleMemAlloc(options.get(), kMaxSingleAllocation);
  TIFFOpenOptionsSetErrorHandlerExtR(options.get(), on_error, messages_.get());
  TIFFOpenOptionsSetWarningHandlerExtR(options.get(), on_warning, messages_.get());
  tiff_.reset(TIFFOpenExt(path.c_str(), mode, options.get()));
}

}  // namespace gravure
