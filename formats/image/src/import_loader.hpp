#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/formats/import_module.hpp"

namespace gravure {

/// Loads the import module when it is first wanted and keeps its opener. Thread-safe. The shared library itself stays
/// loaded until the program ends: what it brought along (thread pools, static objects) cannot be unloaded safely.
class ImportLoader {
 public:
  ImportLoader() = default;
  ImportLoader(const ImportLoader&) = delete;
  ImportLoader& operator=(const ImportLoader&) = delete;

  /// The module's opener. `wanted_for` names the file in errors.
  Result<const ImageOpener*> opener(const std::string& wanted_for);

 private:
  using Opener = std::unique_ptr<ImageOpener, void (*)(ImageOpener*) noexcept>;
  std::mutex mutex_;
  Opener opener_{nullptr, [](ImageOpener*) noexcept {}};
};

/// Where the module is looked for, in this order.
std::vector<std::string> import_module_places();

}  // namespace gravure
