#include "gravure/formats/import_module.hpp"

namespace {

#if defined(GRAVURE_FALSE_INTERFACE)
const gravure::ImportModule kModule = {gravure::kImportAbiVersion + 1, nullptr, nullptr, nullptr, nullptr};
#elif defined(GRAVURE_FALSE_RELEASE)
const gravure::ImportModule kModule = {gravure::kImportAbiVersion, "0.0.1-old", "nothing", nullptr, nullptr};
#endif

}  // namespace

#if !defined(GRAVURE_FALSE_EMPTY)
extern "C" const gravure::ImportModule* gravure_import_module() {
  return &kModule;
}
#endif
