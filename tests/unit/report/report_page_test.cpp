#include "gravure/formats/report_page.hpp"

#include <nlohmann/json.hpp>

#include "dice.hpp"
#include "report_support.hpp"

namespace gravure::report {
namespace {

using gravure::test::emulated;
using test::opener;
using test::prepare;
using test::SmallJob;

/// What `gravure report` puts together, of a job in memory.
ReportData data_of(SmallJob& small) {
  ReportData data;
  data.generator = "gravure test";
  data.program = "job.grv";
  data.header = &small.program.header;
  data.job = small.job;
  Result<VerifyReport> verified = gravure::test::verify_job(small, small.lines());
  EXPECT_TRUE(verified) << verified.error().message;
  data.verified = std::move(verified).value();
  data.seam = seam_series(data.verified, small.program.header.plan);
  Result<LayerPictures> pictures = layer_pictures(opener(small), emulated(), {});
  EXPECT_TRUE(pictures) << pictures.error().message;
  data.pictures = std::move(pictures).value();
  data.relief = relief_of(data.pictures, small.program.header.plan, std::nullopt);
  gravure::test::MemorySource program(small.program);
  Result<LineView> view = line_view(program, 0, 0);
  EXPECT_TRUE(view) << view.error().message;
  data.line = std::move(view).value();
  return data;
}

std::size_t occurrences(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) {
    ++count;
  }
  return count;
}

TEST(ReportPage, HoldsTheFiguresThatWereComputed) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 7);
  const ReportData data = data_of(small);
  const Result<std::string> text = report_json(data);
  ASSERT_TRUE(text) << text.error().message;
  const nlohmann::json json = nlohmann::json::parse(text.value());
  EXPECT_TRUE(json["verdict"]["within_limits"].get<bool>());
  EXPECT_EQ(json["verdict"]["fired_pixels"], data.verified.fired_pixels);
  EXPECT_EQ(json["seam"]["max_um"], data.verified.seam_max_um);
  EXPECT_EQ(json["seam"]["points"].size(), 7U);
  EXPECT_EQ(json["job"]["ticks"], std::to_string(data.header->plan.job.ticks));
  EXPECT_EQ(json["job"]["fires"], "white");
  EXPECT_EQ(json["clock"]["counter"]["increment"], std::to_string(data.header->plan.ab.increment));
  EXPECT_EQ(json["pictures"]["layers"].size(), 3U);
  EXPECT_EQ(json["line"]["edge_steps"].size(), data.line.edge_ticks.size());
  EXPECT_EQ(json["relief"]["unit"], "pulses");
}

TEST(ReportPage, TakesWhateverTheJobSaysForText) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  const std::string hostile = "</script><script>alert(1)</script><img src=x onerror=alert(2)>\"'&\x01\xff";
  small.program.header.plan.title = hostile;
  small.program.header.sources.resize(3);
  small.program.header.sources[0].path = hostile;
  ReportData data = data_of(small);
  data.program = hostile;
  data.verified.violations.push_back(hostile);
  const Result<std::string> page = report_page(data);
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_EQ(occurrences(page.value(), "<script>alert"), 0U);
  EXPECT_EQ(occurrences(page.value(), "<img src=x"), 0U);
  EXPECT_EQ(occurrences(page.value(), "</script>"), 3U);  // data, 3-D view, page
}

TEST(ReportPage, NeedsNoOtherFileAndNoNetwork) {
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::black, 3);
  const Result<std::string> page = report_page(data_of(small));
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_NE(page.value().find("default-src 'none'"), std::string::npos);
  for (const char* part : {"<link", "src=\"http", "href=\"http", "@import"}) {
    EXPECT_EQ(occurrences(page.value(), part), 0U) << part;
  }
}

TEST(ReportPage, StaysSmallWhateverTheLayers) {
  // 300 layers of noise, as large as the page shows them at most.
  SmallJob small;
  prepare(small, LinesAlong::rows, Fires::white, 3);
  ReportData data = data_of(small);
  const LayerPicturesOptions options;
  gravure::test::Dice dice;
  data.pictures.cells = {500, options.most_shown_cells / options.most_shown_layers / 500};
  data.pictures.picture = {195'000, 190'000};
  data.pictures.seam_place = {0, options.most_seam_columns, options.most_seam_lines};
  data.pictures.layers.assign(300, {});
  for (std::int64_t layer = 0; layer < options.most_shown_layers; ++layer) {
    LayerPicture& picture = data.pictures.layers[static_cast<std::size_t>(layer)];
    for (std::int64_t i = 0; i < data.pictures.cells.area(); ++i) {
      picture.shares.push_back(static_cast<std::byte>(dice.word() & 0xFFU));
    }
    for (std::int64_t i = 0; i < data.pictures.seam_extent().area(); ++i) {
      picture.seam.push_back(dice.coin() ? std::byte{255} : std::byte{0});
    }
  }
  data.relief.cells.assign(static_cast<std::size_t>(options.most_cells), 1.0);
  const Result<std::string> page = report_page(data);
  ASSERT_TRUE(page) << page.error().message;
  EXPECT_LT(page.value().size(), 15'000'000U);
}

TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace gravure::report
