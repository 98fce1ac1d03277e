// The job of the table by Leptonica, the one peer that keeps a bit a bit: leptonica IN OUT rows|columns
// The library is taken as it is at run time, so that nothing but its package is needed. Exit status 77: it is not
// there.
#include <dlfcn.h>

#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

namespace {

struct Pix;

struct Leptonica {
  void* library = dlopen("liblept.so.5", RTLD_NOW);
  template <class F>
  F* find(const char* name) const {
    return reinterpret_cast<F*>(dlsym(library, name));
  }
};

}  // namespace

int main(int argc, char** argv) {
  const Leptonica lept;
  if (lept.library == nullptr) {
    return 77;
  }
  if (argc != 4) {
    return 2;
  }
  Pix* pix = lept.find<Pix*(const char*)>("pixRead")(argv[1]);
  if (pix == nullptr) {
    return 1;
  }
  const auto height_of = lept.find<int(Pix*)>("pixGetHeight");
  const auto words_of = lept.find<int(Pix*)>("pixGetWpl");
  const auto data_of = lept.find<std::uint32_t*(Pix*)>("pixGetData");
  const auto flip = lept.find<Pix*(Pix*, Pix*)>("pixFlipLR");
  if (std::string(argv[3]) == "columns") {  // a quarter turn and a flip are a transposition
    Pix* turned = lept.find<Pix*(Pix*, int)>("pixRotate90")(pix, 1);
    lept.find<void(Pix**)>("pixDestroy")(&pix);
    pix = flip(nullptr, turned);
    lept.find<void(Pix**)>("pixDestroy")(&turned);
  }
  Pix* mirrored = flip(nullptr, pix);
  const int width = lept.find<int(Pix*)>("pixGetWidth")(pix);
  const int words = words_of(pix);
  const auto bytes = static_cast<std::size_t>((width + 7) / 8);
  // It reads a bilevel TIFF as 1 = black, in words of the machine.
  std::vector<std::uint8_t> line(static_cast<std::size_t>(words) * 4);
  std::FILE* out = std::fopen(argv[2], "wb");
  const auto padding = static_cast<std::uint8_t>(width % 8 == 0 ? 0xFF : 0xFF << (8 - width % 8));
  for (int y = 0; y < height_of(pix); ++y) {
    const std::uint32_t* from = data_of((y & 1) != 0 ? mirrored : pix) + static_cast<std::ptrdiff_t>(y) * words;
    for (int i = 0; i < words; ++i) {
      const std::uint32_t word = __builtin_bswap32(~from[i]);
      __builtin_memcpy(&line[static_cast<std::size_t>(i) * 4], &word, 4);
    }
    line[bytes - 1] &= padding;
    std::fwrite(line.data(), 1, bytes, out);
  }
  return std::fclose(out) == 0 ? 0 : 1;
}
