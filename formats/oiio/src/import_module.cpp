#include "gravure/formats/import_module.hpp"

#include <OpenImageIO/oiioversion.h>

#include "oiio_opener.hpp"

namespace {

gravure::ImageOpener* create() noexcept {
  try {
    return new gravure::oiio::OiioOpener();
  } catch (...) {
    return nullptr;
  }
}

void destroy(gravure::ImageOpener* opener) noexcept {
  delete opener;
}

constexpr gravure::ImportModule kModule = {gravure::kImportAbiVersion, GRAVURE_VERSION,
                                           "OpenImageIO " OIIO_VERSION_STRING, create, destroy};

}  // namespace

extern "C" __attribute__((visibility("default"))) const gravure::ImportModule* gravure_import_module() {
  return &kModule;
}
