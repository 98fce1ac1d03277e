// The job of the table by OpenImageIO and a loop that packs: oiio IN OUT rows|columns
#include <OpenImageIO/imageio.h>

#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 4) {
    return 2;
  }
  const bool columns = std::string(argv[3]) == "columns";
  const auto in = OIIO::ImageInput::open(argv[1]);
  if (!in) {
    return 1;
  }
  const int width = in->spec().width;
  const int height = in->spec().height;
  const int pixels = columns ? height : width;
  const int lines = columns ? width : height;
  const auto row = static_cast<std::size_t>(width);
  const auto bytes = static_cast<std::size_t>((pixels + 7) / 8);
  constexpr int kRows = 64;
  std::vector<std::uint8_t> band(row * kRows);
  std::vector<std::uint8_t> out(bytes * static_cast<std::size_t>(lines));
  for (int y = 0; y < height; y += kRows) {
    const int count = std::min(kRows, height - y);
    if (!in->read_scanlines(0, 0, y, y + count, 0, 0, 1, OIIO::TypeUInt8, band.data())) {
      return 1;
    }
    for (int r = 0; r < count; ++r) {
      for (int x = 0; x < width; ++x) {
        const int line = columns ? x : y + r;
        const int at = columns ? y + r : x;
        const int slot = (line & 1) != 0 ? pixels - 1 - at : at;
        if (band[static_cast<std::size_t>(r) * row + static_cast<std::size_t>(x)] != 0) {
          out[static_cast<std::size_t>(line) * bytes + static_cast<std::size_t>(slot / 8)] |=
              static_cast<std::uint8_t>(0x80U >> (slot % 8));
        }
      }
    }
  }
  std::FILE* file = std::fopen(argv[2], "wb");
  return file != nullptr && std::fwrite(out.data(), 1, out.size(), file) == out.size() && std::fclose(file) == 0 ? 0
                                                                                                                 : 1;
}
