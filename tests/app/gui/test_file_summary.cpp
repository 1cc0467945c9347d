// What the loader says of files before they are opened; recent files; several files at once.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <QDir>
#include <QSignalSpy>
#include <filesystem>

#include "app/cli/text_table.h"
#include "app/gui/file_summary.h"
#include "app/gui/recent_files.h"
#include "core/material_file.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"
#include "tests/app/gui/model_test.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;

TEST(FileSummaries, SayWhatAFileIsAndHowMuchIsInIt) {
  const test::TemporaryFolder folder;
  const Sample sample = make_sample("diamond-vacancy", {.atoms = 3000});
  write_atoms(folder.file("d.dat"), sample.atoms, sample.unit_cell);
  write_atoms(folder.file("d.xyz"), sample.atoms);
  PipelineReport report;
  const Material material = preprocess(folder.file("d.dat"), {}, report);
  write_material(folder.file("d.crb"), material);
  write_material(folder.file("d.crt"), material);
  const QString atoms = QString::fromStdString(cli::grouped(material.atoms.size()) + " atoms");
  const auto summary = [&](const std::string& name) { return summarize_file(folder.file(name)); };

  EXPECT_EQ(summary("d.dat").kind, FileKind::atoms);
  EXPECT_TRUE(summary("d.dat").text.startsWith("Atoms (.dat)"));
  EXPECT_EQ(summary("d.xyz").kind, FileKind::atoms);
  EXPECT_TRUE(summary("d.xyz").text.startsWith("Atoms (.xyz): " + atoms)) << summary("d.xyz").text.toStdString();
  for (const char* name : {"d.crb", "d.crt"}) {
    EXPECT_EQ(summary(name).kind, FileKind::material);
    EXPECT_TRUE(summary(name).text.startsWith(QString("Material (.%1): ").arg(name + 2) + atoms))
        << summary(name).text.toStdString();
    EXPECT_TRUE(summary(name).text.contains("tetrahedra"));
    EXPECT_EQ(summary(name).problem, "");
  }
  folder.file("m.vtk", "# vtk DataFile Version 3.0\n");
  EXPECT_EQ(summary("m.vtk").kind, FileKind::mesh);
  folder.file("a.dump", "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n4321\nITEM: BOX BOUNDS\n");
  EXPECT_TRUE(summary("a.dump").text.contains("4,321 atoms")) << summary("a.dump").text.toStdString();
  folder.file("a.data", "LAMMPS\n\n777 atoms\n2 atom types\n");
  EXPECT_TRUE(summary("a.data").text.contains("777 atoms"));
  folder.file("p.png", "\x89PNG");
  EXPECT_EQ(summary("p.png").kind, FileKind::picture);
}

TEST(FileSummaries, SayWhyAFileCannotBeOpened) {
  const test::TemporaryFolder folder;
  EXPECT_TRUE(summarize_file(folder.file("none.dat")).problem.contains("no file"));
  EXPECT_TRUE(summarize_file(folder.path().string()).problem.contains("folder"));
  EXPECT_TRUE(summarize_file(folder.file("empty.dat", "")).problem.contains("empty"));
  EXPECT_NE(summarize_file(folder.file("cut.crb", std::string_view("ATOMESH\0\3\0\0", 11))).problem, "");
  ASSERT_EQ(::mkfifo(folder.file("pipe").c_str(), 0600), 0);
  EXPECT_TRUE(summarize_file(folder.file("pipe")).problem.contains("no ordinary file"));  // and does not wait for it
  if (::geteuid() != 0) {
    folder.file("secret.dat", "x");
    ::chmod(folder.file("secret.dat").c_str(), 0);
    EXPECT_TRUE(summarize_file(folder.file("secret.dat")).problem.contains("may not be read"));
  }
}

TEST(FileChoices, TakeOneFileAndOneSetOfParameters) {
  EXPECT_EQ(choose_files({"a.crb"}).data, "a.crb");
  EXPECT_EQ(choose_files({"a.crf", "b.dat"}).data, "b.dat");
  EXPECT_EQ(choose_files({"a.CRF", "b.dat"}).parameters, "a.CRF");
  EXPECT_EQ(choose_files({"a.crf"}).data, "");
  EXPECT_EQ(choose_files({"m.node", "m.ele"}).data, "m.node");  // one mesh
  EXPECT_EQ(choose_files({"a.crb"}).problem, "");
  const FileChoice two = choose_files({"x/a.crb", "b.crb", "c.crf"});
  EXPECT_EQ(two.data, "");
  EXPECT_EQ(two.parameters, "");
  EXPECT_TRUE(two.problem.contains("a.crb, b.crb")) << two.problem.toStdString();
  EXPECT_TRUE(choose_files({"a.crf", "b.crf"}).problem.contains(".crf"));
  EXPECT_NE(choose_files({"m.node", "n.ele"}).problem, "");
  EXPECT_TRUE(choose_files({QDir::tempPath()}).problem.contains("folder"));
}

TEST(RecentFileLists, KeepTheNewestFirstBetweenRuns) {
  test::core_application();
  const test::TemporaryFolder folder;
  const QString settings = QString::fromStdString(folder.file("s.ini"));
  {
    RecentFiles recent("data", settings);
    EXPECT_TRUE(recent.files().isEmpty());
    QSignalSpy changed(&recent, &RecentFiles::changed);
    for (const char* file : {"/a.dat", "/b.dat", "/a.dat"}) recent.add(file);
    EXPECT_EQ(changed.size(), 3);
    EXPECT_EQ(recent.files(), (QStringList{"/a.dat", "/b.dat"}));
    RecentFiles parameters("parameters", settings);
    parameters.add("/a.crf");
  }
  RecentFiles recent("data", settings);
  EXPECT_EQ(recent.files(), (QStringList{"/a.dat", "/b.dat"}));
  EXPECT_EQ(RecentFiles("parameters", settings).files(), QStringList{"/a.crf"});
  for (int i = 0; i < 30; ++i) recent.add(QString("/%1.dat").arg(i));
  EXPECT_EQ(recent.files().size(), RecentFiles::most);
  EXPECT_EQ(recent.files().first(), "/29.dat");
  recent.remove("/29.dat");
  EXPECT_EQ(recent.files().first(), "/28.dat");
  recent.clear();
  EXPECT_TRUE(RecentFiles("data", settings).files().isEmpty());
}

TEST(RecentFileLists, KnowWhatIsNoLongerThere) {
  test::core_application();
  const test::TemporaryFolder folder;
  RecentFiles recent("data", QString::fromStdString(folder.file("s.ini")));
  const QString there = QString::fromStdString(folder.file("there.dat", "x"));
  const QString gone = QString::fromStdString(folder.file("gone.dat"));
  recent.add(gone);
  recent.add(there);
  EXPECT_FALSE(recent.missing(gone));  // not looked yet
  QSignalSpy changed(&recent, &RecentFiles::changed);
  recent.look();
  ASSERT_TRUE(test::wait_until([&] { return !changed.empty(); }));
  EXPECT_TRUE(recent.missing(gone));
  EXPECT_FALSE(recent.missing(there));
}

}  // namespace
