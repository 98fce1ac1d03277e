#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "gravure/core/error.hpp"
#include "gravure/core/image_source.hpp"
#include "gravure/core/progress.hpp"
#include "gravure/formats/tiff.hpp"

namespace gravure {

class ImportLoader;

/// Every image gravure reads: bilevel TIFF and binary PBM/PGM directly, all else (grey TIFF, PNG, BMP, OpenEXR) through
/// the import module, which is loaded at the first file that needs it. docs/formats/images.md lists what is read and
/// what is refused. May be used from several threads at once; must outlive the sources it opened.
///
/// The module is the file GRAVURE_IMPORT_MODULE names, else the first found beside the running program, in
/// ../lib/gravure or the multi-arch folder from there. Missing: io, with what to install. Of another version:
/// version_mismatch, with both versions.
class ImageFiles final : public ImageOpener {
 public:
  ImageFiles();
  ~ImageFiles() override;
  ImageFiles(const ImageFiles&) = delete;
  ImageFiles& operator=(const ImageFiles&) = delete;

  Result<std::int64_t> count_pages(const std::string& path) const override;
  Result<std::unique_ptr<ImageSource>> open(const std::string& path, std::int64_t page) const override;

 private:
  BilevelTiffOpener tiff_;
  std::unique_ptr<ImportLoader> module_;
};

/// Files that match shell patterns (* ? [..]) relative to `folder`, pattern by pattern, each pattern's matches in
/// natural order ("layer_2.tif" before "layer_10.tif"), each file once. Folders never match. Fails with bad_file naming
/// each pattern that matches nothing.
Result<std::vector<std::string>> expand_patterns(const std::string& folder, const std::vector<std::string>& patterns);

/// Byte order, except that runs of digits compare as numbers; a strict weak order in any locale.
bool natural_less(std::string_view a, std::string_view b);

/// FIPS 180-4 SHA-256, lower-case hexadecimal.
std::string sha256_text(std::string_view bytes);
/// The same of a file, streamed. Fails with bad_file when it is missing, io when it cannot be read, cancelled when
/// asked to stop.
Result<std::string> sha256_file(const std::string& path, const CancelToken* cancel = nullptr);

/// The same, a part at a time.
class Sha256File {
 public:
  static Result<Sha256File> open(const std::string& path);
  Sha256File(Sha256File&&) noexcept;
  Sha256File& operator=(Sha256File&&) noexcept;
  Sha256File(const Sha256File&) = delete;
  Sha256File& operator=(const Sha256File&) = delete;
  ~Sha256File();

  /// Takes in the next bytes; how many, 0 at the end of the file.
  Result<std::size_t> next();
  /// Of what was taken in; the last call.
  std::string finish();

 private:
  struct State;
  explicit Sha256File(std::unique_ptr<State> state);
  std::unique_ptr<State> state_;
};

}  // namespace gravure
