// The job of the table by libvips: vips IN OUT.tif rows|columns. Output is a bilevel TIFF without compression.
// The library is taken as it is at run time, so that nothing but its package is needed. Exit status 77: it is not
// there.
#include <dlfcn.h>

#include <cstdio>
#include <string>

namespace {

struct Image;
constexpr int kHorizontal = 0;
constexpr int kQuarterTurn = 1;

struct Vips {
  void* library = dlopen("libvips.so.42", RTLD_NOW);
  template <class F>
  F* find(const char* name) const {
    return reinterpret_cast<F*>(dlsym(library, name));
  }
};

bool run(const Vips& vips, const char* from, const char* to, bool columns) {
  const auto flip = vips.find<int(Image*, Image**, int, ...)>("vips_flip");
  Image* in = vips.find<Image*(const char*, ...)>("vips_image_new_from_file")(from, nullptr);
  Image* picture = in;
  Image* turned = nullptr;
  if (columns) {
    if (vips.find<int(Image*, Image**, int, ...)>("vips_rot")(in, &turned, kQuarterTurn, nullptr) != 0 ||
        flip(turned, &picture, kHorizontal, nullptr) != 0) {
      return false;
    }
  }
  const int width = vips.find<int(Image*)>("vips_image_get_width")(picture);
  const int height = vips.find<int(Image*)>("vips_image_get_height")(picture);
  Image* mirrored = nullptr;
  Image* xy = nullptr;
  Image* y = nullptr;
  Image* odd = nullptr;
  Image* out = nullptr;
  double two = 2;
  double one = 1;
  return flip(picture, &mirrored, kHorizontal, nullptr) == 0 &&
         vips.find<int(Image**, int, int, ...)>("vips_xyz")(&xy, width, height, nullptr) == 0 &&
         vips.find<int(Image*, Image**, int, ...)>("vips_extract_band")(xy, &y, 1, nullptr) == 0 &&
         vips.find<int(Image*, Image**, double*, int, ...)>("vips_remainder_const")(y, &xy, &two, 1, nullptr) == 0 &&
         vips.find<int(Image*, Image**, int, double*, int, ...)>("vips_relational_const")(xy, &odd, 0, &one, 1,
                                                                                          nullptr) == 0 &&
         vips.find<int(Image*, Image*, Image*, Image**, ...)>("vips_ifthenelse")(odd, mirrored, picture, &out,
                                                                                 nullptr) == 0 &&
         vips.find<int(Image*, const char*, ...)>("vips_tiffsave")(out, to, "bitdepth", 1, nullptr) == 0;
}

}  // namespace

int main(int argc, char** argv) {
  const Vips vips;
  if (vips.library == nullptr) {
    return 77;
  }
  if (argc != 4 || vips.find<int(const char*)>("vips_init")(argv[0]) != 0) {
    return 2;
  }
  if (!run(vips, argv[1], argv[2], std::string(argv[3]) == "columns")) {
    std::fprintf(stderr, "%s\n", vips.find<const char*()>("vips_error_buffer")());
    return 1;
  }
  return 0;
}
