// Any bytes are contours or an Error; contours are what the header promises, and come back from both forms.

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <set>
#include <string>
#include <string_view>

#include "gravure/formats/contours.hpp"

namespace {

constexpr std::string_view kPath = "fuzz.json";

void require(bool holds) {
  if (!holds) {
    std::abort();
  }
}

void check_error(const gravure::Error& error) {
  require(error.code == gravure::ErrorCode::bad_file || error.code == gravure::ErrorCode::out_of_range);
  require(error.message.substr(0, kPath.size()) == kPath);
  for (const char c : error.message) {
    require(static_cast<unsigned char>(c) >= 0x20U);
  }
}

void check_contours(const std::vector<gravure::Contour>& contours) {
  std::set<std::int64_t> ids;
  for (const gravure::Contour& contour : contours) {
    require(ids.insert(contour.id).second && contour.points_mm.size() >= 2);
    const auto& d = contour.direction;
    require(std::abs(std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]) - 1) < 1e-14);
  }
  for (const std::string& text :
       {gravure::formats::contours_to_json(contours), gravure::formats::contours_to_csv(contours)}) {
    const auto again = gravure::formats::parse_contours(text, std::string(kPath));
    require(static_cast<bool>(again) && again.value().contours.size() == contours.size());
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto file = gravure::formats::parse_contours(text, std::string(kPath));
  file ? check_contours(file.value().contours) : check_error(file.error());
  return 0;
}
