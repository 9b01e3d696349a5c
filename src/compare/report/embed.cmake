# cmake -DFOLDER=... -DOUTPUT=... -P embed.cmake: writes the report's page, with style and script in it, as a C++ source.
foreach(part html css js)
    file(READ "${FOLDER}/page.${part}" ${part})
endforeach()
string(REPLACE "@STYLE@" "${css}" html "${html}")
string(REPLACE "@SCRIPT@" "${js}" html "${html}")
file(WRITE "${OUTPUT}" "#include \"compare/report_page.h\"\n\nnamespace lsde {\n\n\
const std::string_view kReportPage = R\"page(${html})page\";\n\n}  // namespace lsde\n")
