#include "gravure/emulator/rtl_board.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <vector>

namespace gravure::emulator {
namespace {

namespace fs = std::filesystem;

constexpr char kEnvironment[] = "GRAVURE_RTL_MODULE";
constexpr char kFunction[] = "gravure_rtl_module";

/// Where the program looks: what the environment names, else beside itself and in the libraries of its installation.
std::vector<fs::path> places() {
  if (const char* const named = std::getenv(kEnvironment); named != nullptr && *named != '\0') {
    return {named};
  }
  std::error_code unknown;
  const fs::path bin = fs::read_symlink("/proc/self/exe", unknown).parent_path();
  const fs::path name = "gravure_rtl.so";
  return {bin.parent_path() / GRAVURE_MODULE_FOLDER / name, bin.parent_path() / "lib" / "gravure" / name, bin / name};
}

}  // namespace

Result<RtlBoard> RtlBoard::load() {
  std::string tried;
  for (const fs::path& place : places()) {
    tried += " " + place.string();
    std::error_code unknown;
    if (!fs::exists(place, unknown)) {
      continue;
    }
    void* const library = ::dlopen(place.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (library == nullptr) {
      const char* const reason = ::dlerror();
      return Error{ErrorCode::io,
                   place.string() + " cannot be loaded: " + (reason != nullptr ? reason : "no reason given")};
    }
    const auto function = reinterpret_cast<RtlModuleFunction>(::dlsym(library, kFunction));
    const RtlModule* const module = function != nullptr ? function() : nullptr;
    if (module == nullptr || module->abi_version != kRtlAbiVersion) {
      return Error{ErrorCode::version_mismatch,
                   place.string() + " is no module of this program: install program and module from the same build"};
    }
    return RtlBoard(*module);
  }
  return Error{ErrorCode::io, "the Verilog board is not built here, it is at none of" + tried +
                                  ": install the Debian package verilator and build gravure again, or set " +
                                  kEnvironment + " to the module"};
}

}  // namespace gravure::emulator
