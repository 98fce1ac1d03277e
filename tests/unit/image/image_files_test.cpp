#include "gravure/formats/image_files.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "gravure/formats/image_kind.hpp"
#include "gravure/formats/import_module.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "temp_folder.hpp"

namespace gravure::test {
namespace {

/// The environment variable for the length of a scope.
class ModuleAt {
 public:
  explicit ModuleAt(const std::string& path) { ::setenv("GRAVURE_IMPORT_MODULE", path.c_str(), 1); }
  ModuleAt(const ModuleAt&) = delete;
  ModuleAt& operator=(const ModuleAt&) = delete;
  ~ModuleAt() { ::unsetenv("GRAVURE_IMPORT_MODULE"); }
};

constexpr char kPng[] = "\x89PNG\r\n\x1a\n and what follows";

/// Opening a PNG needs the module; this is what comes of it.
Error error_with_module(const std::string& module) {
  const TempFolder folder;
  put_file(folder / "a.png", kPng);
  const ModuleAt environment(module);
  const ImageFiles files;
  const auto source = files.open(folder / "a.png", 0);
  const auto pages = files.count_pages(folder / "a.png");
  EXPECT_FALSE(source);
  EXPECT_FALSE(pages);
  return source ? Error{} : source.error();
}

TEST(ImageFiles, ReadsBilevelTiffWithoutAnyModule) {
  const TempFolder folder;
  BilevelTiffPage page;
  page.width = 8;
  page.height = 1;
  auto writer = BilevelTiffWriter::create(folder / "a.tif", page);
  const std::byte row{0xA5};
  ASSERT_TRUE(writer && writer.value().append_rows({&row, 1}) && writer.value().commit());
  const ModuleAt environment("/none/at/all.so");
  const ImageFiles files;
  EXPECT_EQ(files.count_pages(folder / "a.tif").value(), 1);
  const auto source = files.open(folder / "a.tif", 0);
  ASSERT_TRUE(source) << source.error().message;
  std::byte read{};
  ASSERT_TRUE(source.value()->read_rows(0, 1, {&read, 1}));
  EXPECT_EQ(read, row);
}

TEST(ImageFiles, SayWhatToInstallWhenTheModuleIsMissing) {
  const Error error = error_with_module("/none/at/all.so");
  EXPECT_EQ(error.code, ErrorCode::io);
  EXPECT_NE(error.message.find("a.png"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("/none/at/all.so"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("libopenimageio2.4"), std::string::npos) << error.message;
  EXPECT_NE(error.message.find("GRAVURE_IMPORT=ON"), std::string::npos) << error.message;
}

TEST(ImageFiles, RefuseAModuleThatIsNoLibrary) {
  const TempFolder folder;
  put_file(folder / "module.so", "not a library");
  const Error error = error_with_module(folder / "module.so");
  EXPECT_EQ(error.code, ErrorCode::io);
  EXPECT_NE(error.message.find("cannot be loaded"), std::string::npos) << error.message;
}

TEST(ImageFiles, RefuseAModuleOfAnotherInterfaceVersion) {
  const Error error = error_with_module(GRAVURE_MODULE_INTERFACE);
  EXPECT_EQ(error.code, ErrorCode::version_mismatch);
  EXPECT_NE(error.message.find("interface version " + std::to_string(kImportAbiVersion + 1) + ", this program " +
                               std::to_string(kImportAbiVersion)),
            std::string::npos)
      << error.message;
  EXPECT_NE(error.message.find("from the same build"), std::string::npos) << error.message;
}

TEST(ImageFiles, RefuseAModuleOfAnotherGravure) {
  const Error error = error_with_module(GRAVURE_MODULE_RELEASE);
  EXPECT_EQ(error.code, ErrorCode::version_mismatch);
  EXPECT_NE(error.message.find("0.0.1-old"), std::string::npos) << error.message;
}

TEST(ImageFiles, RefuseALibraryThatIsNoModule) {
  const Error error = error_with_module(GRAVURE_MODULE_EMPTY);
  EXPECT_EQ(error.code, ErrorCode::version_mismatch);
  EXPECT_NE(error.message.find("gravure_import_module"), std::string::npos) << error.message;
}

TEST(ImageFiles, RefuseWhatIsNoImageWithoutAskingTheModule) {
  const TempFolder folder;
  const ModuleAt environment("/none/at/all.so");
  const ImageFiles files;
  const auto message_for = [&](const std::string& path) {
    const auto source = files.open(path, 0);
    EXPECT_FALSE(source);
    EXPECT_EQ(source.error().code, ErrorCode::bad_file) << source.error().message;
    return source.error().message;
  };
  EXPECT_NE(message_for(folder / "none.png").find("No such file"), std::string::npos);
  EXPECT_NE(message_for(folder.path()).find("is a folder"), std::string::npos);
  put_file(folder / "empty.png", "");
  EXPECT_NE(message_for(folder / "empty.png").find("is empty"), std::string::npos);
  put_file(folder / "photo.jpg", "\xFF\xD8\xFF\xE0 and so on");
  EXPECT_NE(message_for(folder / "photo.jpg").find("images are TIFF, PNG, BMP, OpenEXR, PBM or PGM"),
            std::string::npos);
}

TEST(ImageKind, IsToldByTheFirstBytesNotTheName) {
  const TempFolder folder;
  const std::pair<std::string, ImageKind> heads[] = {{std::string("II\x2a\0....", 8), ImageKind::tiff},
                                                     {std::string("MM\0\x2b....", 8), ImageKind::tiff},
                                                     {kPng, ImageKind::png},
                                                     {"BM....", ImageKind::bmp},
                                                     {"\x76\x2f\x31\x01....", ImageKind::openexr},
                                                     {"P4\n8 8\n", ImageKind::pnm},
                                                     {"P2 # grey\n", ImageKind::pnm}};
  for (const auto& [bytes, kind] : heads) {
    put_file(folder / "misnamed.jpg", bytes);
    EXPECT_EQ(image_kind(folder / "misnamed.jpg").value(), kind) << image_kind_name(kind);
  }
  for (const char* const bytes : {"P", "P4", "P7\n", "P4x", "B", "\x89PN"}) {
    put_file(folder / "x", bytes);
    EXPECT_FALSE(image_kind(folder / "x")) << bytes;
  }
}

}  // namespace
}  // namespace gravure::test
