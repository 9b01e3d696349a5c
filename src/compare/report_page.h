// The report's page without its data. The source is made at build time from report/page.{html,css,js} by
// report/embed.cmake.
#pragma once

#include <string_view>

namespace lsde {

// HTML with the markers @REPORT@ (JSON) and @DATA@ (blocks of base64) once each.
extern const std::string_view kReportPage;

}  // namespace lsde
