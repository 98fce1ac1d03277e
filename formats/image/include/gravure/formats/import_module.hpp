#pragma once

#include <cstdint>

#include "gravure/core/image_source.hpp"

/// What the program and an import module agree on. The module is a shared library found at run time, so that programs
/// which read nothing but bilevel TIFF do not pay for the hundreds of libraries behind the other formats. Nothing but
/// gravure's own types crosses this border, and no exception does.

namespace gravure {

/// Raised whenever ImportModule, ImageOpener, ImageSource, ImageInfo, Error or Result change.
inline constexpr std::uint32_t kImportAbiVersion = 2;

struct ImportModule {
  std::uint32_t abi_version;                      ///< first for ever: looked at before anything else
  const char* gravure_version;                    ///< of the build the module belongs to
  const char* reader;                             ///< what it reads with, for example "OpenImageIO 2.4.7"
  ImageOpener* (*create)() noexcept;              ///< null when out of memory; thread-safe
  void (*destroy)(ImageOpener* opener) noexcept;  ///< takes back what create() gave
};

/// The one function a module exports, with C linkage.
inline constexpr char kImportModuleFunction[] = "gravure_import_module";
using ImportModuleFunction = const ImportModule* (*)();

}  // namespace gravure
