#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "gravure/formats/grv.hpp"
#include "gravure/formats/image_files.hpp"
#include "gravure/formats/tiff.hpp"
#include "gravure/formats/tiff_writer.hpp"
#include "gravure/twin/unroll.hpp"
#include "program/path_program.hpp"
#include "program/program_files.hpp"
#include "verb.hpp"

namespace gravure::cli {
namespace {

struct UnrollArguments {
  std::string program;
  std::optional<std::int64_t> revolution;  // this, or
  std::optional<std::int64_t> layer;       // this one
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

/// Where the picture comes from, unless what is asked for is not there.
std::optional<LayerOrigin> picture_origin(const ProgramHeader& header, const UnrollArguments& options) {
  const bool helical = header.plan.carriage.has_value();
  if (options.layer) {
    const bool there = *options.layer >= 0 && *options.layer < image_layers(header);
    return there ? std::optional(origin_of(header, *options.layer)) : std::nullopt;
  }
  if (helical || *options.revolution < 0 || *options.revolution >= header.plan.job.revolutions) {
    return std::nullopt;
  }
  return origin_of(header, header.layer_of_revolution[static_cast<std::size_t>(*options.revolution)]);
}

/// The size tags and the photometric sense of the source, where it is still there, so that the picture equals a layer
/// written the same way; else its size on the workpiece.
Result<BilevelTiffPage> page_of(const ProgramHeader& header, const UnrollArguments& options, const UnrolledSize& size,
                                const SourceImage* source) {
  const double along = 1000.0 / to_double(header.plan.line.pixel_pitch_um);
  const double across = 1000.0 / to_double(header.plan.rotary.line_pitch_um);
  const bool rows = header.lines_along == LinesAlong::rows;
  BilevelTiffPage page;
  page.width = size.width;
  page.height = size.height;
  page.compression = options.compression == "source" ? TiffCompression::deflate : compression_of(options.compression);
  page.x_dots_per_mm = rows ? along : across;
  page.y_dots_per_mm = rows ? across : along;
  GRAVURE_CHECK(refuse_overwrite(options.output, inputs_of_program(options.program, header), Writes::picture));
  if (source == nullptr) {
    return page;  // where that is wrong, unroll() says so
  }
  const std::string path = locate_source(*source, header, options.program, {});
  const ImageFiles files;
  if (const Result<std::unique_ptr<ImageSource>> image = files.open(path, source->page); !path.empty() && image) {
    page.x_dots_per_mm = image.value()->info().x_dots_per_mm;
    page.y_dots_per_mm = image.value()->info().y_dots_per_mm;
    page.zero_is_white = image.value()->info().zero_is_white;
    if (options.compression == "source") {
      page.compression = compression_of_source(path, source->page);
    }
  }
  return page;
}

/// What a bitmap on a surface comes back as; bad_argument for a path that is none.
Result<BilevelTiffPage> path_page_of(const ProgramHeader& header, const UnrollArguments& options) {
  const std::optional<PathPicture>& picture = header.plan.path->picture;
  if (!picture || header.plan.rotary.line_pitch_um <= 0) {
    return Error{ErrorCode::bad_argument, "the program marks a path, not a picture: see verify"};
  }
  const auto source = std::find_if(header.sources.begin(), header.sources.end(), [](const SourceImage& each) {
    return each.width > 0;  // height fields and other files of a job have no pixels here
  });
  return page_of(header, options, {picture->width, picture->height},
                 source == header.sources.end() ? nullptr : &*source);
}

/// A program that follows a path is one layer, gone along once.
Result<void> check_selected(const UnrollArguments& options) {
  const auto is_first = [](const std::string& option, const std::optional<std::int64_t>& number) -> Result<void> {
    if (number.value_or(0) == 0) {
      return {};
    }
    return Error{ErrorCode::out_of_range,
                 option + " " + std::to_string(*number) + ": a program that follows a path has number 0 alone"};
  };
  GRAVURE_CHECK(is_first("--layer", options.layer));
  return is_first("--revolution", options.revolution);
}

Result<int> run_unroll(const UnrollArguments& options, const Command& command) {
  GRAVURE_CHECK(check_tiff_name("unroll", options.output));
  GRAVURE_TRY(const GrvProgram opened, GrvProgram::open(options.program, command.memory_bytes()));
  const std::unique_ptr<LineSource> program = opened.reader();
  const ProgramHeader& header = opened.header();
  if (header.plan.path) {
    GRAVURE_CHECK(check_selected(options));
    GRAVURE_TRY(const BilevelTiffPage page, path_page_of(header, options));
    return unroll_path_program(*program, page, options.output, command);
  }
  const std::optional<LayerOrigin> origin = picture_origin(header, options);
  const SourceImage* shown = origin ? &header.sources[origin->source] : nullptr;
  GRAVURE_TRY(const BilevelTiffPage page, page_of(header, options, unrolled_size(header), shown));
  UnrollOptions unroll_options;
  unroll_options.memory_bytes = command.memory_bytes();
  unroll_options.table_bytes = opened.table_bytes();
  unroll_options.cancel = &cancel_token();  // before there is a temporary file: from here on Ctrl-C takes it away again
  GRAVURE_TRY(BilevelTiffWriter writer, BilevelTiffWriter::create(options.output, page));
  std::vector<std::byte> inverted;
  const RowSink sink = [&](std::span<const std::byte> rows, std::int64_t) {
    if (!page.zero_is_white) {
      return writer.append_rows(rows);
    }
    inverted.assign(rows.begin(), rows.end());
    for (std::byte& byte : inverted) {
      byte = ~byte;
    }
    return writer.append_rows(inverted);
  };
  GRAVURE_CHECK(options.layer ? unroll_layer(*program, emulated_devices(), *options.layer, sink, unroll_options)
                              : unroll(*program, emulated_devices(), *options.revolution, sink, unroll_options));
  GRAVURE_CHECK(writer.commit());
  const SourceImage& source = *shown;
  if (command.json) {
    Json json = {{"picture", options.output}};
    if (options.revolution) {
      json["revolution"] = *options.revolution;
      json["layer"] =
          images_of_layers(header)[header.layer_of_revolution[static_cast<std::size_t>(*options.revolution)]];
    } else {
      json["layer"] = *options.layer;
    }
    json["source"] = source.path;
    json["page"] = source.page;
    json["level"] = origin->level;
    json["width"] = page.width;
    json["height"] = page.height;
    json["fires"] = polarity_name(header.fires);
    print_json(json);
  } else {
    const std::string what =
        options.layer ? fmt::format("layer {}", *options.layer) : fmt::format("revolution {}", *options.revolution);
    print(fmt::format("{}: {} as exposed, {} x {}, {} fires; its {} is {} page {} level {}\n", options.output, what,
                      page.width, page.height, polarity_name(header.fires), options.layer ? "image" : "layer",
                      source.path, source.page, origin->level));
  }
  return kDone;
}

}  // namespace

void add_unroll(CLI::App& app, Command& command) {
  CLI::App* verb =
      add_verb(app, command, "unroll", "What one revolution or layer exposes, as the picture it came from");
  const auto options = std::make_shared<UnrollArguments>();
  verb->add_option("PROGRAM", options->program, "Program file (.grv)")->required();
  CLI::Option* revolution =
      verb->add_option("--revolution", options->revolution, "Revolution (flat: pass), from 0; not in helical programs")
          ->check(integer_from(0, kMostIndex));
  verb->add_option("--layer", options->layer, "Layer of the image stack, from 0, whatever revolutions expose it")
      ->excludes(revolution)
      ->check(integer_from(0, kMostIndex));
  verb->add_option("-o,--output", options->output, "Bilevel TIFF to write")->required();
  verb->add_option("--compression", options->compression,
                   "Of the TIFF; source: that of the layer where it is a bilevel TIFF")
      ->check(CLI::IsMember({"source", "none", "packbits", "lzw", "deflate", "g4"}))
      ->capture_default_str();
  add_work_options(*verb, command);
  verb->callback([&command, options] {
    if (!options->revolution && !options->layer) {
      throw CLI::RequiredError("--revolution or --layer");
    }
    command.run = [&command, options] { return run_unroll(*options, command); };
  });
}

}  // namespace gravure::cli
