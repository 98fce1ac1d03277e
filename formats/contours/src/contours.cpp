#include "gravure/formats/contours.hpp"

#include <fmt/format.h>

#include "contour_list.hpp"
#include "gravure/core/byte_order_mark.hpp"
#include "gravure/core/file_output.hpp"

namespace gravure::formats {

Result<ContourFile> parse_contours(std::string_view text, const std::string& path) {
  const std::string_view plain = without_byte_order_mark(text);
  const std::size_t first = plain.find_first_not_of(" \t\r\n");
  if (text.size() > kMaxContourBytes) {
    return Error{ErrorCode::bad_file, fmt::format("{}: {} bytes: must be at most {}; take several files", path,
                                                  text.size(), kMaxContourBytes)};
  }
  const bool is_json = first != std::string_view::npos && (plain[first] == '{' || plain[first] == '[');
  Result<ContourFile> file = is_json ? contour_file::parse_json(plain) : contour_file::parse_csv(text);
  if (!file) {
    const std::string& message = file.error().message;
    const bool has_place = !message.empty() && message[0] >= '0' && message[0] <= '9';
    return Error{file.error().code, path + (has_place ? ":" : ": ") + message};
  }
  return file;
}

Result<ContourFile> read_contours(const std::string& path) {
  GRAVURE_TRY(const std::string text, read_file(path, kMaxContourBytes));
  return parse_contours(text, path);
}

std::string contours_to_json(const std::vector<Contour>& contours) {
  std::string json = "{\"contours\": [";
  for (std::size_t i = 0; i < contours.size(); ++i) {
    const Contour& contour = contours[i];
    json += fmt::format("{}\n  {{\"id\": {}, \"direction\": [{}, {}, {}], \"points\": [", i > 0 ? "," : "", contour.id,
                        contour.direction[0], contour.direction[1], contour.direction[2]);
    for (std::size_t p = 0; p < contour.points_mm.size(); ++p) {
      const auto& point = contour.points_mm[p];
      json += fmt::format("{}[{}, {}, {}]", p > 0 ? ", " : "", point[0], point[1], point[2]);
    }
    json += "]}";
  }
  return json + "\n]}\n";
}

std::string contours_to_csv(const std::vector<Contour>& contours) {
  std::string csv = "id,x_mm,y_mm,z_mm,u,v,w\n";
  for (const Contour& contour : contours) {
    for (const auto& point : contour.points_mm) {
      csv += fmt::format("{},{},{},{},{},{},{}\n", contour.id, point[0], point[1], point[2], contour.direction[0],
                         contour.direction[1], contour.direction[2]);
    }
  }
  return csv;
}

}  // namespace gravure::formats
