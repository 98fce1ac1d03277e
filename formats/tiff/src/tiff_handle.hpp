#pragma once

#include <tiffio.h>

#include <array>
#include <memory>
#include <string>

#include "gravure/core/error.hpp"

namespace gravure {

/// What libtiff said since the last clear(). Fixed buffers: the handlers run inside C code and must not throw.
struct TiffMessages {
  std::array<char, 256> error{};
  std::array<char, 256> warning{};
  bool sizes_missing = false;  ///< the page does not say how long its strips or tiles are: libtiff guessed
  bool sizes_wrong = false;    ///< or says something impossible

  void clear() { error[0] = warning[0] = '\0'; }
  bool any() const { return error[0] != '\0' || warning[0] != '\0'; }
  /// " (libtiff: ...)", or empty.
  std::string text() const;
};

/// One TIFF*, closed on every way out, with its messages kept beside it: nothing is global, nothing is printed.
class TiffHandle {
 public:
  /// `mode` as for TIFFOpen. Null where libtiff cannot open it; messages() then says why.
  TiffHandle(const std::string& path, const char* mode);

  explicit operator bool() const noexcept { return tiff_ != nullptr; }
  TIFF* get() const noexcept { return tiff_.get(); }
  TiffMessages& messages() const noexcept { return *messages_; }
  /// Closes now, so that what libtiff says while closing can be read.
  void close() noexcept { tiff_.reset(); }

 private:
  struct Close {
    void operator()(TIFF* tiff) const noexcept { TIFFClose(tiff); }
  };
  std::unique_ptr<TiffMessages> messages_;  // outlives tiff_ and keeps its address
  std::unique_ptr<TIFF, Close> tiff_;
};

}  // namespace gravure
