// What is open, chosen and drawn, without a widget.
#include <gtest/gtest.h>

#include <QCoreApplication>
#include <QSignalSpy>

#include "app/gui/workspace.h"
#include "core/error.h"
#include "core/material_file.h"
#include "preprocess/pipeline.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"
#include "tests/app/gui/window_test.h"
#include "tests/core/random_parameters.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::wait_for;

Document salt(const test::TemporaryFolder& folder, const MaterialParts& parts) {
  return open_document(test::cracked_salt_crb(folder.path().string()), parts, no_progress());
}

TEST(ParameterHistory, GesturesAreOneStepAndOthersAreTheirOwn) {
  ParameterHistory history;
  Parameters next;
  for (const double zoom : {1.5, 2.0, 3.0}) {
    next.zoom = zoom;
    EXPECT_TRUE(history.change(next, "Zoom", "view"));
  }
  next.roll = 10.0;
  EXPECT_TRUE(history.change(next, "Roll"));
  next.roll = 20.0;
  EXPECT_TRUE(history.change(next, "Roll"));
  EXPECT_FALSE(history.change(next, "Nothing"));
  EXPECT_EQ(history.undo_name(), "Roll");
  history.undo();
  EXPECT_EQ(history.now().roll, 10.0);
  history.undo();
  EXPECT_EQ(history.undo_name(), "Zoom");
  EXPECT_EQ(history.redo_name(), "Roll");
  history.undo();
  EXPECT_EQ(history.now(), Parameters());
  EXPECT_FALSE(history.can_undo());
  history.redo();
  EXPECT_EQ(history.now().zoom, 3.0);
  // What was undone is gone once something else is done; the gesture starts anew.
  next = history.now();
  next.zoom = 4.0;
  history.change(next, "Zoom", "view");
  EXPECT_FALSE(history.can_redo());
  history.undo();
  EXPECT_EQ(history.now().zoom, 3.0);
}

TEST(ParameterHistory, EndedGesturesAreNotGoneOnWith) {
  ParameterHistory history;
  Parameters next;
  next.zoom = 2.0;
  history.change(next, "Zoom", "view");
  history.end_gesture();
  next.zoom = 3.0;
  history.change(next, "Zoom", "view");
  history.undo();
  EXPECT_EQ(history.now().zoom, 2.0);
}

TEST(ParameterHistory, GivesBackWhatLayOverTheView) {
  using cli::PictureParts;
  const PictureParts before{.legend = true, .scale_bar = true, .tripod = true};
  const PictureParts after{.legend = false, .scale_bar = true, .tripod = false};
  ParameterHistory history;
  Parameters next;
  next.zoom = 2.0;
  EXPECT_TRUE(history.change(next, "View of a.png", {.before = before, .after = after}));
  next.roll = 10.0;
  EXPECT_TRUE(history.change(next, "Roll"));
  EXPECT_EQ(history.undo(), std::nullopt);
  EXPECT_EQ(history.undo(), before);
  EXPECT_EQ(history.now(), Parameters());
  EXPECT_EQ(history.redo(), after);
  EXPECT_EQ(history.now().zoom, 2.0);
  EXPECT_EQ(history.redo(), std::nullopt);
  // What lies over the view may be all that changes.
  EXPECT_FALSE(history.change(next, "View of a.png", {.before = after, .after = after}));
  EXPECT_TRUE(history.change(next, "View of b.png", {.before = after, .after = before}));
  EXPECT_FALSE(history.can_redo());
  EXPECT_EQ(history.undo_name(), "View of b.png");
  EXPECT_EQ(history.undo(), after);
  EXPECT_EQ(history.now(), next);
}

TEST(Workspace, EveryRowIsChangedUndoneAndRedone) {
  const test::TemporaryFolder folder;
  Workspace workspace;
  workspace.show_document(salt(folder, {}));
  unsigned seed = 0;
  for (const std::string& key : parameter_keys(workspace.document()->species())) {
    SCOPED_TRACE(key);
    const std::string before = get_parameter(workspace.parameters(), key);
    std::string after = before;
    while (after == before)
      after = get_parameter(test::random_parameters(++seed, workspace.document()->species()), key);
    workspace.set(key, after);
    EXPECT_EQ(get_parameter(workspace.parameters(), key), after);
    EXPECT_EQ(get_parameter(workspace.shown(), key), after);
    workspace.undo();
    EXPECT_EQ(get_parameter(workspace.parameters(), key), before);
    EXPECT_EQ(get_parameter(workspace.shown(), key), before);
    workspace.redo();
    EXPECT_EQ(get_parameter(workspace.parameters(), key), after);
    workspace.reset(key);
    EXPECT_EQ(get_parameter(workspace.parameters(), key), get_parameter({}, key));
    workspace.undo();
    workspace.undo();
    EXPECT_EQ(workspace.parameters(), Parameters());
    workspace.end_gesture();
  }
}

TEST(Workspace, RefusesWhatTheTableRefusesAndStaysAsItWas) {
  Workspace workspace;
  const QSignalSpy changes(&workspace, &Workspace::parameters_changed);
  EXPECT_THROW(workspace.set("volume_surface.face_alpha", "7"), UsageError);
  EXPECT_THROW(workspace.set("volume_surface.face_alfa", "0.5"), UsageError);
  Parameters wrong;
  wrong.xray.alpha_length = -1.0;
  EXPECT_THROW(workspace.change(wrong, "Wrong"), UsageError);
  EXPECT_EQ(workspace.parameters(), Parameters());
  EXPECT_EQ(changes.count(), 0);
}

TEST(Workspace, WithoutAutoApplyAModesGroupIsDrawnOnceApplied) {
  Workspace workspace;
  workspace.set_auto_apply(Mode::xray, false);
  const QSignalSpy drawn(&workspace, &Workspace::shown_changed);
  workspace.set("xray.alpha_length", "0.5");
  EXPECT_EQ(workspace.parameters().xray.alpha_length, 0.5);
  EXPECT_EQ(workspace.shown().xray.alpha_length, Parameters().xray.alpha_length);
  EXPECT_TRUE(workspace.apply_pending(Mode::xray));
  EXPECT_FALSE(workspace.apply_pending(Mode::volume));
  EXPECT_EQ(drawn.count(), 0);
  workspace.set("surface.shininess", "5");  // another mode's is drawn at once
  EXPECT_EQ(workspace.shown().surface.shininess, 5.0);
  EXPECT_EQ(drawn.count(), 1);
  workspace.apply(Mode::xray);
  EXPECT_EQ(workspace.shown().xray.alpha_length, 0.5);
  EXPECT_FALSE(workspace.apply_pending(Mode::xray));
  EXPECT_EQ(drawn.count(), 2);
  workspace.set("xray.alpha_length", "0.25");
  workspace.set_auto_apply(Mode::xray, true);
  EXPECT_EQ(workspace.shown().xray.alpha_length, 0.25);
}

TEST(Workspace, ReadsThePartsOfAModeWhenItIsChosen) {
  const test::TemporaryFolder folder;
  Workspace workspace;
  Parameters atoms;
  atoms.mode = Mode::atoms;
  workspace.show_document(salt(folder, parts_needed(atoms)), atoms);
  EXPECT_TRUE(workspace.document()->material->mesh.tetrahedra.empty());
  EXPECT_TRUE(workspace.document()->material->surface.triangles.empty());
  const QSignalSpy parts(&workspace, &Workspace::parts_changed);
  workspace.set("mode", "surface");
  EXPECT_FALSE(workspace.has_parts(parts_needed(workspace.shown())));
  ASSERT_TRUE(wait_for([&] { return parts.count() == 1; }));
  EXPECT_FALSE(workspace.document()->material->surface.triangles.empty());
  EXPECT_TRUE(workspace.document()->material->mesh.tetrahedra.empty());
  // Faster than the reading: only what is wanted in the end must be there in the end.
  workspace.set("mode", "volume");
  workspace.set("mode", "volume-surface");
  ASSERT_TRUE(wait_for([&] { return workspace.has_parts(parts_needed(workspace.shown())); }));
  EXPECT_FALSE(workspace.document()->material->mesh.tetrahedra.empty());
}

TEST(Workspace, ASecondSampleIsSeenFromTheStartAndKeepsTheColours) {
  const test::TemporaryFolder folder;
  Workspace workspace;
  workspace.show_document(salt(folder, {}));
  workspace.set("view.azimuth", "77");
  workspace.set("cut_plane.1.enabled", "true");
  workspace.set("surface.color", "#102030");
  workspace.set_rotation_center(Vec3(1, 2, 3));
  workspace.show_document(salt(folder, {}));
  EXPECT_EQ(workspace.parameters().azimuth, Parameters().azimuth);
  EXPECT_FALSE(workspace.parameters().cut_planes[0].enabled);
  EXPECT_NE(workspace.parameters().surface.color, Parameters().surface.color);
  EXPECT_EQ(workspace.rotation_center(), workspace.bounds().center());
  EXPECT_FALSE(workspace.history().can_undo());
}

}  // namespace
