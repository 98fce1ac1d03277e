#pragma once

#include <string_view>

/// The front end as it lies in formats/report/page, and the bundle of the 3-D view; made into a source at build time.
namespace gravure::page_parts {

std::string_view style() noexcept;      ///< CSS
std::string_view body() noexcept;       ///< HTML
std::string_view script() noexcept;     ///< JavaScript of the page
std::string_view path_body() noexcept;  ///< of programs that follow a path
std::string_view path_script() noexcept;
std::string_view view3d() noexcept;  ///< JavaScript of the 3-D view; empty without Node

}  // namespace gravure::page_parts
