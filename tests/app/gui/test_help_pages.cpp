// The help: every parameter has its entry, links lead somewhere, the search finds.
#include <gtest/gtest.h>

#include <QRegularExpression>
#include <QSet>

#include "app/gui/help_pages.h"
#include "app/gui/parameter_hints.h"
#include "core/parameters.h"

namespace atomesh::gui {
namespace {

const HelpSection* section_of(const HelpPlace& place) {
  for (const HelpSection& section : place.page->sections) {
    if (section.anchor == place.anchor) return &section;
  }
  return nullptr;
}

TEST(HelpMarkup, MakesHtmlOfWhatThePagesUse) {
  const HelpMarkup markup = read_markup(
      "# The *first* page\n\nTwo **bold** words and `a * b < c`,\nsee [there](help:files).\n\n- one\n  goes on\n- "
      "two\n\n"
      "| a | b |\n| --- | --- |\n| 1 | `2` |\n\n    code  <x>\n      more\n\n## Below\n\nend\n");
  EXPECT_EQ(markup.html,
            "<h1><a name=\"the-first-page\"></a>The <i>first</i> page</h1>\n"
            "<p>Two <b>bold</b> words and <code>a * b &lt; c</code>, see <a href=\"help:files\">there</a>.</p>\n"
            "<ul><li>one goes on</li><li>two</li></ul>\n"
            "<table border=\"1\" cellspacing=\"0\" cellpadding=\"4\" style=\"border-collapse: collapse\">"
            "<tr><th align=\"left\">a</th><th align=\"left\">b</th></tr>"
            "<tr><td align=\"left\">1</td><td align=\"left\"><code>2</code></td></tr></table>\n"
            "<pre>code  &lt;x&gt;\n  more</pre>\n"
            "<h2><a name=\"below\"></a>Below</h2>\n<p>end</p>\n");
  ASSERT_EQ(markup.sections.size(), 2U);
  EXPECT_EQ(markup.sections[0].text,
            "Two bold words and a * b < c, see there. one goes on two a b 1 2 code  <x>   more");
  EXPECT_EQ(markup.sections[1].anchor, "below");
  EXPECT_EQ(markup.sections[1].text, "end");
}

TEST(HelpPages, HaveTitlesTextAndAnchorsOnce) {
  QSet<QString> ids;
  for (const HelpPage& page : help_pages()) {
    EXPECT_FALSE(ids.contains(page.id));
    ids.insert(page.id);
    EXPECT_FALSE(page.title.isEmpty()) << page.id.toStdString();
    QSet<QString> anchors;
    for (const HelpSection& section : page.sections) {
      EXPECT_FALSE(anchors.contains(section.anchor)) << page.id.toStdString() << ' ' << section.anchor.toStdString();
      anchors.insert(section.anchor);
      EXPECT_TRUE(page.html.contains("<a name=\"" + section.anchor + "\">")) << section.anchor.toStdString();
      // What was meant as markup was read as such.
      EXPECT_FALSE(section.text.contains("**") || section.text.contains("](")) << section.text.toStdString();
    }
  }
  EXPECT_GE(help_pages().size(), 15U);
}

TEST(HelpPages, EveryLinkLeadsSomewhere) {
  static const QRegularExpression link("href=\"([^\"]+)\"");
  int links = 0;
  for (const HelpPage& page : help_pages()) {
    for (auto hits = link.globalMatch(page.html); hits.hasNext();) {
      const QString target = hits.next().captured(1);
      ASSERT_TRUE(target.startsWith("help:")) << target.toStdString();
      const auto place = help_place(target.mid(5));
      ASSERT_TRUE(place) << page.id.toStdString() << ": " << target.toStdString();
      if (!place->anchor.isEmpty()) {
        EXPECT_NE(section_of(*place), nullptr) << target.toStdString();
      }
      ++links;
    }
  }
  EXPECT_GT(links, 20);
}

TEST(HelpPages, EveryParameterHasItsEntry) {
  for (const std::string& key : parameter_keys({"Na", "Ow"})) {
    const auto place = help_place(QString::fromStdString(key));
    ASSERT_TRUE(place) << key;
    ASSERT_NE(place->page, nullptr) << key;
    const HelpSection* section = section_of(*place);
    ASSERT_NE(section, nullptr) << key;
    const ParameterRow& row = parameter_row(key);
    EXPECT_TRUE(section->text.contains(QString::fromStdString(row.help))) << key;
    EXPECT_TRUE(section->text.contains(QString::fromStdString(expected_value(row)))) << key;
    EXPECT_TRUE(section->text.contains(QString::fromStdString(default_text(row.key)))) << key;
    EXPECT_TRUE(place->page->html.contains(QString::fromStdString(row.help).toHtmlEscaped())) << key;
  }
}

TEST(HelpPages, EveryGroupAndModeHasItsPlace) {
  for (const std::string& group : groups()) {
    const auto place = help_place(QString::fromStdString(group));
    ASSERT_TRUE(place) << group;
    if (!place->anchor.isEmpty()) {
      EXPECT_NE(section_of(*place), nullptr) << group;
    }
  }
  for (const Mode mode : {Mode::volume_surface, Mode::volume, Mode::surface, Mode::xray, Mode::atoms}) {
    const auto place = help_place(QString::fromUtf8(mode_name(mode).data()));
    ASSERT_TRUE(place);
    EXPECT_EQ(help_place(QString::fromStdString(group_of_mode(mode)))->page, place->page);
  }
  EXPECT_EQ(help_place("light.3.position")->anchor, "light.N.position");
  EXPECT_EQ(help_place("pictures#saving-a-picture")->page->id, "pictures");
  EXPECT_FALSE(help_place("no such topic"));
  EXPECT_FALSE(help_place(""));
}

TEST(HelpPages, SayWhatTheDefaultsAre) {
  const auto text = [](const char* key) { return section_of(*help_place(key))->text; };
  EXPECT_TRUE(text("light.1.intensity").contains("0.35 (number 2), 1 (the others)"))
      << text("light.1.intensity").toStdString();
  EXPECT_TRUE(text("cut_plane.4.normal").contains("1,0,0"));
}

TEST(HelpSearch, FindsWhatIsMeant) {
  const auto first = [](const char* query) {
    const auto hits = search_help(query);
    return hits.empty() ? QString() : hits.front().page->id + "#" + hits.front().section->anchor;
  };
  EXPECT_EQ(first("face alpha"), "volume-surface#volume_surface.face_alpha");
  EXPECT_EQ(first("volume_surface.face_alpha"), "volume-surface#volume_surface.face_alpha");
  EXPECT_EQ(first("light.3.position"), "cut-planes#light.N.position");
  EXPECT_EQ(first("atoms.color.Na"), "atoms#atoms.color.SPECIES");
  EXPECT_EQ(first("miller"), "cut-planes#by-miller-indices");
  EXPECT_EQ(first("MOUSE"), "controls#mouse");
  EXPECT_EQ(first("keys"), "controls#keys");
  EXPECT_TRUE(first("histogram").startsWith("color-map#") || first("histogram").startsWith("volume#"));
  EXPECT_EQ(first("transparent background"), "display#background");
  EXPECT_EQ(first("saving picture"), "pictures#saving-a-picture");
  EXPECT_EQ(first("vacancy clusters"), "defects#clusters");
  EXPECT_EQ(first(""), "");
  EXPECT_EQ(first("xyzzy"), "");
  for (const HelpHit& hit : search_help("opacity")) EXPECT_FALSE(hit.section->title.isEmpty());
  EXPECT_TRUE(search_help("squared displacements").front().excerpt.contains("squared displacements"));
}

}  // namespace
}  // namespace atomesh::gui
