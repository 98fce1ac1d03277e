// One step of the table that tests/bench/run prints, in a process of its own, so that its peak of memory is its own:
//   gravure_table_step pictures FOLDER                         writes the pictures
//   gravure_table_step STEP FILE WORK SECONDS                  repeats a step after a warm-up; prints CPU ms of one,
//                                                              peak MiB, wall ms of one
//   gravure_table_step slices FILE OUT                         slices of a map in memory; the lines of all go to OUT
//   gravure_table_step growth GPX sparse|dense rows|columns    a generated picture through the compiler
//   gravure_table_step roller FILE                             a BigTIFF of 188,496 x 200,000 pixels, one metre of a
//                                                              roller
//   gravure_table_step bits FILE OUT                           the lines of a program, or the rows of a bilevel TIFF,
//                                                              as they are
// docs/benchmarks.md has the method.
#include "table_step.hpp"

#include <tiffio.h>

#include <fstream>
#include <memory>
#include <span>
#include <string>

#include "gravure/formats/grv.hpp"

namespace {

using namespace gravure;
using namespace gravure::bench;

void dump_program(const std::string& path, std::ofstream& out) {
  const std::unique_ptr<LineSource> program = must(open_grv(path));
  const ProgramHeader& header = program->header();
  const std::int64_t lines = header.plan.rotary.lines_per_revolution;
  const std::int64_t per_chunk = program->lines_per_chunk();
  Bytes bits(static_cast<std::size_t>(per_chunk * header.line_bytes()));
  for (std::int64_t layer = 0; layer < static_cast<std::int64_t>(header.layers.size()); ++layer) {
    for (std::int64_t first = 0; first < lines; first += per_chunk) {
      const auto count = static_cast<std::size_t>(std::min(per_chunk, lines - first) * header.line_bytes());
      must(program->decode(must(program->fetch({layer, first / per_chunk})), std::span(bits).first(count)));
      out.write(reinterpret_cast<const char*>(bits.data()), static_cast<std::streamsize>(count));
    }
  }
}

void dump(const std::string& path, const std::string& to) {
  std::ofstream out(to, std::ios::binary);
  if (path.ends_with(".grv")) {
    dump_program(path, out);
    return;
  }
  TIFF* tiff = TIFFOpen(path.c_str(), "rm");
  std::uint16_t photometric = 0;
  std::uint32_t height = 0;
  TIFFGetField(tiff, TIFFTAG_PHOTOMETRIC, &photometric);
  TIFFGetField(tiff, TIFFTAG_IMAGELENGTH, &height);
  Bytes row(static_cast<std::size_t>(TIFFScanlineSize(tiff)));
  for (std::uint32_t y = 0; y < height; ++y) {
    TIFFReadScanline(tiff, row.data(), y);
    for (std::byte& byte : row) {
      byte = photometric == PHOTOMETRIC_MINISWHITE ? ~byte : byte;
    }
    out.write(reinterpret_cast<const char*>(row.data()), static_cast<std::streamsize>(row.size()));
  }
  TIFFClose(tiff);
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> given(argv + 1, argv + argc);
  if (given.size() == 2 && given[0] == "pictures") {
    write_pictures(given[1]);
  } else if (given.size() == 4 && given[0] == "growth") {
    grow(std::stod(given[1]), given[2] == "dense", given[3] == "columns");
  } else if (given.size() == 3 && given[0] == "slices") {
    slice_held(picture_of(given[1]), given[2]);
  } else if (given.size() == 2 && given[0] == "roller") {
    write_roller(given[1]);
  } else if (given.size() == 3 && given[0] == "bits") {
    dump(given[1], given[2]);
  } else if (given.size() == 4) {
    repeat(step_named(given[0], picture_of(given[1]), given[2]), std::stod(given[3]));
  } else {
    stop("see the head of table_step.cpp");
  }
  return 0;
}
