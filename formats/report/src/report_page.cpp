#include "gravure/formats/report_page.hpp"

#include <array>

#include "page_parts.hpp"

namespace gravure {
namespace {

/// JSON inside a script element: no character can end it there.
void add_script_safe(std::string_view json, std::string& page) {
  for (const char c : json) {
    if (c == '<') {
      page += "\\u003c";
    } else {
      page += c;
    }
  }
}

/// What stands on the page where scripts are not run.
std::string plain_verdict(const std::vector<std::string>& violations) {
  std::string text = violations.empty() ? "<p>Within limits.</p>" : "<p>NOT within limits:</p><ul>";
  for (const std::string& violation : violations) {
    text += "<li>" + escape_html(violation) + "</li>";
  }
  return text + (violations.empty() ? "" : "</ul>") + "<p>Charts and pictures need JavaScript.</p>";
}

struct Parts {
  const std::string& title;
  const std::string& program;  ///< takes the place of a title that is empty
  std::string_view body;
  std::string_view view3d;
  std::string_view script;
};

std::string page_of(const Parts& parts, const std::vector<std::string>& violations, const std::string& json) {
  constexpr std::size_t kRest = 128 * 1024;  // style, title and verdict
  std::string page;                          // may hold megabytes of pictures
  page.reserve(json.size() + parts.body.size() + parts.view3d.size() + parts.script.size() + kRest);
  page += "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  page += "<title>" + escape_html(parts.title.empty() ? parts.program : parts.title) + " - gravure report</title>\n";
  page += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  // Nothing is fetched, and a page that is taken somewhere else cannot be made to.
  page +=
      "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; img-src data: blob:; "
      "style-src 'unsafe-inline'; script-src 'unsafe-inline'\">\n";
  page += "<meta name=\"color-scheme\" content=\"light dark\">\n<style>\n";
  page += page_parts::style();
  page += "</style>\n</head>\n<body>\n<noscript>" + plain_verdict(violations) + "</noscript>\n";
  page += parts.body;
  page += "<script type=\"application/json\" id=\"report-data\">";
  add_script_safe(json, page);
  page += "</script>\n<script>\n";
  page += parts.view3d;
  page += "</script>\n<script>\n";
  page += parts.script;
  page += "</script>\n</body>\n</html>\n";
  return page;
}

}  // namespace

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::array<unsigned, 3> three = {};
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    for (std::size_t k = 0; k < count; ++k) {
      three[k] = static_cast<unsigned char>(bytes[i + k]);
    }
    const unsigned all = three[0] << 16U | three[1] << 8U | three[2];
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[all >> (18 - 6 * k) & 0x3FU] : '=';
    }
  }
  return text;
}

bool report_has_3d() noexcept {
  return !page_parts::view3d().empty();
}

Result<std::string> report_page(const report::ReportData& data) {
  GRAVURE_TRY(const std::string json, report_json(data));
  return page_of(
      {data.header->plan.title, data.program, page_parts::body(), page_parts::view3d(), page_parts::script()},
      data.verified.violations, json);
}

Result<std::string> path_report_page(const report::PathReportData& data) {
  GRAVURE_TRY(const std::string json, path_report_json(data));
  return page_of(
      {data.header->plan.title, data.program, page_parts::path_body(), page_parts::view3d(), page_parts::path_script()},
      data.verified.violations, json);
}

}  // namespace gravure
