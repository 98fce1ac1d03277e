#include "import_loader.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <string_view>

namespace gravure {
namespace {

constexpr char kEnvironment[] = "GRAVURE_IMPORT_MODULE";

Error failure(ErrorCode code, const std::string& wanted_for, const std::string& what) {
  return {code, wanted_for + ": only bilevel TIFF is read without the import module, and " + what};
}

Error missing(const std::string& wanted_for, const std::vector<std::string>& places) {
  std::string what = "that is at none of";
  for (const std::string& place : places) {
    what += " " + place;
  }
  return failure(ErrorCode::io, wanted_for,
                 what +
                     ": build and install gravure with GRAVURE_IMPORT=ON (Debian packages libopenimageio-dev to "
                     "build, libopenimageio2.4 to run), or set " +
                     kEnvironment + " to the module, or convert the image to a bilevel TIFF");
}

Result<const ImportModule*> load(const std::string& place, const std::string& wanted_for) {
  void* const library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    const char* const reason = ::dlerror();
    return failure(ErrorCode::io, wanted_for,
                   place + " cannot be loaded: " + (reason != nullptr ? reason : "no reason given") +
                       ": install the Debian package libopenimageio2.4");
  }
  const auto function = reinterpret_cast<ImportModuleFunction>(::dlsym(library, kImportModuleFunction));
  const ImportModule* const module = function != nullptr ? function() : nullptr;
  if (module == nullptr) {
    return failure(ErrorCode::version_mismatch, wanted_for,
                   place + " is no gravure import module (it has no " + kImportModuleFunction + ")");
  }
  const std::string remedy = ": install the program and the module from the same build";
  if (module->abi_version != kImportAbiVersion) {
    return failure(ErrorCode::version_mismatch, wanted_for,
                   place + " has interface version " + std::to_string(module->abi_version) + ", this program " +
                       std::to_string(kImportAbiVersion) + remedy);
  }
  if (std::string_view(module->gravure_version) != GRAVURE_VERSION) {
    return failure(ErrorCode::version_mismatch, wanted_for,
                   place + " is of gravure " + module->gravure_version + ", this program of " GRAVURE_VERSION + remedy);
  }
  return module;
}

}  // namespace

std::vector<std::string> import_module_places() {
  if (const char* const named = std::getenv(kEnvironment); named != nullptr && *named != '\0') {
    return {named};
  }
  std::error_code unknown;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", unknown);
  const std::filesystem::path bin = program.parent_path();
  std::vector<std::string> places;
  for (const std::filesystem::path& folder :
       {bin.parent_path() / GRAVURE_MODULE_FOLDER, bin.parent_path() / "lib" / "gravure", bin}) {
    if (std::string place = (folder / GRAVURE_MODULE_NAME).string(); places.empty() || places.back() != place) {
      places.push_back(std::move(place));
    }
  }
  return places;
}

Result<const ImageOpener*> ImportLoader::opener(const std::string& wanted_for) {
  const std::lock_guard lock(mutex_);
  if (opener_ != nullptr) {
    return opener_.get();
  }
  const std::vector<std::string> places = import_module_places();
  for (const std::string& place : places) {
    std::error_code unknown;
    if (!std::filesystem::exists(place, unknown)) {
      continue;
    }
    GRAVURE_TRY(const ImportModule* const module, load(place, wanted_for));
    opener_ = Opener(module->create(), module->destroy);
    if (opener_ == nullptr) {
      throw std::bad_alloc();
    }
    return opener_.get();
  }
  return missing(wanted_for, places);
}

}  // namespace gravure
