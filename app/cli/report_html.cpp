#include "app/cli/report_html.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <ctime>

#include "app/cli/machine.h"
#include "app/cli/report_markup.h"

namespace atomesh::cli {

namespace {

constexpr const char* style = R"(
:root { color-scheme: light dark; --text: #1f2328; --quiet: #59636e; --page: #ffffff; --line: #d1d9e0; --band: #f3f5f7;
  --met: #1a7f37; --missed: #c2280f; }
@media (prefers-color-scheme: dark) {
  :root { --text: #e6edf3; --quiet: #9198a1; --page: #0d1117; --line: #3d444d; --band: #161b22; --met: #4ac26b;
    --missed: #ff8a70; }
}
body { margin: 2rem auto; max-width: 72rem; padding: 0 1rem; background: var(--page); color: var(--text);
  font: 15px/1.5 system-ui, 'DejaVu Sans', sans-serif; }
h1 { font-size: 1.6rem; margin-bottom: 0.2rem; }
h2 { font-size: 1.15rem; margin: 2.2rem 0 0.6rem; border-bottom: 1px solid var(--line); padding-bottom: 0.2rem; }
.origin, .caption, figcaption { color: var(--quiet); }
.caption, figcaption { font-size: 0.9rem; max-width: 60rem; }
figure { margin: 1rem 0; }
figure svg { max-width: 100%; height: auto; display: block; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 0.88rem; font-variant-numeric: tabular-nums; }
th, td { padding: 0.25rem 0.7rem; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { background: var(--band); white-space: nowrap; }
.number { text-align: right; white-space: nowrap; }
.met { color: var(--met); font-weight: 600; }
.missed { color: var(--missed); font-weight: 700; }
)";

// The class of a cell that says whether a requirement is met.
const char* met_class(std::string_view cell) {
  return cell.starts_with("yes") ? "met" : cell.starts_with("NO") ? "missed" : "";
}

void append_table(std::string& out, const TextTable& table) {
  const std::vector<bool> numeric = table.numeric_columns();
  const auto append_row = [&](const std::vector<std::string>& cells, const char* tag, bool heading) {
    out += "<tr>";
    for (std::size_t c = 0; c < cells.size(); ++c) {
      std::string classes = c < numeric.size() && numeric[c] ? "number" : "";
      if (!heading && c < table.headings().size() && table.headings()[c] == "met") classes = met_class(cells[c]);
      out += fmt::format("<{}{}>{}</{}>", tag, classes.empty() ? "" : fmt::format(" class=\"{}\"", classes),
                         escape_markup(cells[c]), tag);
    }
    out += "</tr>\n";
  };
  out += "<div class=\"wide\"><table>\n<thead>\n";
  append_row(table.headings(), "th", true);
  out += "</thead>\n<tbody>\n";
  for (const auto& row : table.rows()) append_row(row, "td", false);
  out += "</tbody>\n</table></div>\n";
}

void append_section(std::string& out, const BenchTable& section) {
  out += "<section>\n";
  if (!section.title.empty()) out += fmt::format("<h2>{}</h2>\n", escape_markup(section.title));
  for (const Plot& plot : section.plots) {
    out += "<figure>\n" + plot_svg(plot);
    if (!plot.caption.empty()) out += fmt::format("<figcaption>{}</figcaption>\n", escape_markup(plot.caption));
    out += "</figure>\n";
  }
  if (!section.table.empty()) append_table(out, section.table);
  if (!section.caption.empty()) out += fmt::format("<p class=\"caption\">{}</p>\n", escape_markup(section.caption));
  out += "</section>\n";
}

}  // namespace

ReportOrigin report_origin() {
  const std::tm now = fmt::gmtime(std::time(nullptr));
  return {machine_name(), build_commit(), fmt::format("{:%Y-%m-%d %H:%M} UTC", now)};
}

std::string report_html(const std::string& title, std::span<const BenchTable> sections, const ReportOrigin& origin) {
  const std::string heading = escape_markup(title);
  std::string out = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\"/>\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"/>\n<title>{}</title>\n"
      "<style>{}</style>\n</head>\n<body>\n<h1>{}</h1>\n<p class=\"origin\">{} · commit {} · {}</p>\n",
      heading, style, heading, escape_markup(origin.machine), escape_markup(origin.commit), escape_markup(origin.date));
  for (const BenchTable& section : sections) append_section(out, section);
  return out + "</body>\n</html>\n";
}

}  // namespace atomesh::cli
