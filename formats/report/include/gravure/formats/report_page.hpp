#pragma once

#include <string>
#include <string_view>

#include "gravure/report/path_view.hpp"
#include "gravure/report/report_data.hpp"

namespace gravure {

/// The data of the report page as one JSON document (docs/report.md); pictures in it are PNG, base64. Fails where a
/// picture cannot be written.
Result<std::string> report_json(const report::ReportData& data);

/// The page itself: one HTML file that needs no network and no other file. What the data says is text there, whatever
/// characters it has.
Result<std::string> report_page(const report::ReportData& data);

/// The same of a program that follows a path: its figures against their limits, the axes over time, the pulses on the
/// surface, and which parts of the other page have no meaning here.
Result<std::string> path_report_json(const report::PathReportData& data);
Result<std::string> path_report_page(const report::PathReportData& data);

/// Has this build the 3-D view? It is bundled where Node and npm are there at configuration; else the page says so.
bool report_has_3d() noexcept;

/// `text` as HTML text or the value of an attribute in double quotes.
std::string escape_html(std::string_view text);

/// Standard base64 with padding.
std::string base64(std::string_view bytes);

}  // namespace gravure
