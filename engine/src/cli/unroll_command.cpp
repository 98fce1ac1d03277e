#include <fmt/format.h>

#include <map>
#include <memory>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/tiff.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/twin/unroll.hpp"
#include "program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct Options {
  std::string program;
  std::int64_t revolution = 0;
  std::string output;
  std::string compression = "source";
};

TiffCompression compression_of(const std::string& name) {
  static const std::map<std::string, TiffCompression> names = {{"none", TiffCompression::none},
                                                               {"packbits", TiffCompression::packbits},
                                                               {"lzw", TiffCompression::lzw},
                                                               {"deflate", TiffCompression::deflate},
                                                               {"g4", TiffCompression::g4}};
  return names.at(name);
}

/// That of a bilevel TIFF which this program could have written; else Deflate.
TiffCompression compression_of_source(const std::string& path, std::int64_t page) {
  const Result<TiffPageInfo> info =
      is_tiff(path) ? BilevelTiffOpener().read_page_info(path, page) : Result<TiffPageInfo>(TiffPageInfo{});
  if (!is_tiff(path) || !info || !info.value().bilevel()) {
    return TiffCompression::deflate;
  }
  static const std::map<int, TiffCompression> known = {{1, TiffCompression::none},
                                                       {4, TiffCompression::g4},
                                                       {5, TiffCompression::lzw},
                                                       {32773, TiffCompression::packbits}};
  const auto found = known.find(info.value().compression);
  return found == known.end() ? TiffCompression::deflate : found->second;
}

/// The size tags and the photometric sense of the source, where it is still there, so that the picture equals a layer
/// written the same way; else its size on the workpiece.
Result<BilevelTiffPage> page_of(const ProgramHeader& header, const Options& options) {
  const UnrolledSize size = unrolled_size(header);
  const double along = 1000.0 / to_double(header.plan.line.pixel_pitch_um);
  const double across = 1000.0 / to_double(header.plan.rotary.line_pitch_um);
  const bool rows = header.lines_along == LinesAlong::rows;
  BilevelTiffPage page;
  page.width = size.width;
  page.height = size.height;
  page.compression = options.compression == "source" ? TiffCompression::deflate : compression_of(options.compression);
  page.x_dots_per_mm = rows ? along : across;
  page.y_dots_per_mm = rows ? across : along;
  if (options.revolution < 0 || options.revolution >= header.plan.job.revolutions) {
    return page;  // unroll() says what is wrong
  }
  const std::uint32_t layer = header.layer_of_revolution[static_cast<std::size_t>(options.revolution)];
  const SourceImage& source = header.sources[static_cast<std::size_t>(header.layers[layer].source)];
  const std::string path = locate_source(source, header, options.program, {});
  GRAVURE_CHECK(refuse_overwrite(options.output, {options.program, path}));
  const ImageFiles files;
  if (const Result<std::unique_ptr<ImageSource>> image = files.open(path, source.page); !path.empty() && image) {
    page.x_dots_per_mm = image.value()->info().x_dots_per_mm;
    page.y_dots_per_mm = image.value()->info().y_dots_per_mm;
    page.zero_is_white = image.value()->info().zero_is_white;
    if (options.compression == "source") {
      page.compression = compression_of_source(path, source.page);
    }
  }
  return page;
}

Result<int> run(const Options& options, const Command& command) {
  GRAVURE_TRY(const std::unique_ptr<LineSource> program, open_grv(options.program));
  const ProgramHeader& header = program->header();
  GRAVURE_TRY(const BilevelTiffPage page, page_of(header, options));
  UnrollOptions unroll_options;
  unroll_options.memory_bytes = command.memory_bytes();
  unroll_options.cancel = &cancel_token();  // before there is a temporary file: from here on Ctrl-C takes it away again
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(options.output, page));
  std::vector<std::byte> inverted;
  GRAVURE_CHECK(unroll(
      *program, emulated_devices(), options.revolution,
      [&](std::span<const std::byte> rows, std::int64_t) {
        if (!page.zero_is_white) {
          return writer.append_rows(rows);
        }
        inverted.assign(rows.begin(), rows.end());
        for (std::byte& byte : inverted) {
          byte = ~byte;
        }
        return writer.append_rows(inverted);
      },
      unroll_options));
  GRAVURE_CHECK(writer.commit());
  const std::uint32_t layer = header.layer_of_revolution[static_cast<std::size_t>(options.revolution)];
  const SourceImage& source = header.sources[static_cast<std::size_t>(header.layers[layer].source)];
  if (command.json) {
    print_json({{"picture", options.output},
                {"revolution", options.revolution},
                {"layer", layer},
                {"source", source.path},
                {"page", source.page},
                {"level", header.layers[layer].level},
                {"width", page.width},
                {"height", page.height},
                {"fires", polarity_name(header.fires)}});
  } else {
    print(fmt::format("{}: revolution {} as exposed, {} x {}, {} fires; its layer is {} page {} level {}\n",
                      options.output, options.revolution, page.width, page.height, polarity_name(header.fires),
                      source.path, source.page, header.layers[layer].level));
  }
  return kDone;
}

}  // namespace

void add_unroll(CLI::App& app, Command& command) {
  CLI::App* verb = add_verb(app, command, "unroll", "What one revolution exposes, as the picture it came from");
  const auto options = std::make_shared<Options>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  verb->add_option("--revolution", options->revolution, "Revolution, from 0")
      ->required()
      ->check(integer_from(0, kMostIndex));
  verb->add_option("-o,--output", options->output, "Bilevel TIFF to write")->required();
  verb->add_option("--compression", options->compression,
                   "Of the TIFF; source: that of the layer where it is a bilevel TIFF")
      ->check(CLI::IsMember({"source", "none", "packbits", "lzw", "deflate", "g4"}))
      ->capture_default_str();
  add_work_options(*verb, command);
  verb->callback([&command, options] { command.run = [&command, options] { return run(*options, command); }; });
}

}  // namespace gravure::cli
