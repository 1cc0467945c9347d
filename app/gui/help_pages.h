// The help inside the program (manual, B.6.3.6): pages written by hand (help/*.md) and, from the parameter table, an
// entry for each parameter. Searchable.
#pragma once

#include <QString>
#include <optional>
#include <vector>

#include "app/gui/help_markup.h"

namespace atomesh::gui {

struct HelpPage {
  QString id;  // "controls", "volume-surface"
  QString title;
  QString html;
  std::vector<HelpSection> sections;  // the first is the page's own
};

// In the order of the contents.
const std::vector<HelpPage>& help_pages();

struct HelpPlace {
  const HelpPage* page;
  QString anchor;  // "" for the top
};
// Where a topic is explained: the id of a page ("controls", "pictures#saving-a-picture"), a group of the parameter
// table
// ("Lights"), or a parameter's key ("light.3.position", "atoms.color.Na"). Nothing for what is none of them.
std::optional<HelpPlace> help_place(const QString& topic);

struct HelpHit {
  const HelpPage* page;
  const HelpSection* section;
  QString excerpt;  // of its text, about the first word that was found
};
// Sections that have every word of `query`, best first: words in a heading count more than in the text, and whole words
// more than parts. A parameter's key finds its entry first.
std::vector<HelpHit> search_help(const QString& query);

}  // namespace atomesh::gui
