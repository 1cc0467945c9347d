// The small part of Markdown that the help is written in, as HTML and as words to search.
#pragma once

#include <QString>
#include <vector>

namespace atomesh::gui {

// A heading and what stands under it up to the next.
struct HelpSection {
  QString anchor;  // <a name> in the HTML; "" before the first heading
  QString title;
  QString text;  // without markup
};

struct HelpMarkup {
  QString html;
  std::vector<HelpSection> sections;
};

// Headings (#, ##, ###), paragraphs, lists (- ), tables, blocks of code (four blanks), **bold**, *slanted*, `code` and
// [text](target). The anchor of a heading is its words in lower case with "-" between them.
HelpMarkup read_markup(const QString& markdown);
// "By Miller indices" → "by-miller-indices"
QString anchor_of(const QString& heading);

}  // namespace atomesh::gui
