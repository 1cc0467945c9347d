// Preprocessing in the window: the same result as the command's, what it tells on its way, what it leaves on the disk,
// and that the window goes on answering.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <QElapsedTimer>
#include <QSignalSpy>
#include <algorithm>
#include <filesystem>
#include <numeric>

#include "app/gui/job.h"
#include "app/gui/pipeline_settings.h"
#include "app/gui/preprocessing.h"
#include "core/error.h"
#include "preprocess/write_atoms.h"
#include "samples/samples.h"
#include "tests/app/gui/model_test.h"
#include "tests/support/temporary_folder.h"

namespace {

using namespace atomesh;
using namespace atomesh::gui;
using test::wait_until;

#if defined(__SANITIZE_ADDRESS__)
constexpr double slowdown = 10.0;  // of code under the sanitizers
#else
constexpr double slowdown = 1.0;
#endif

class PreprocessingRun : public ::testing::Test {
 protected:
  PreprocessingRun() { test::core_application(); }

  void grow(std::size_t atoms) {
    const Sample sample = make_sample("diamond-vacancy", {.atoms = atoms});
    write_atoms(request.input = folder.file("d.dat"), sample.atoms, sample.unit_cell);
  }
  bool ended() const { return run.state() != Preprocessing::State::running; }
  void start_and_finish() {
    run.start(request);
    ASSERT_TRUE(wait_until([&] { return ended(); }));
  }
  std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  std::vector<std::string> stage_names() const {
    std::vector<std::string> names;
    for (const StageRow& row : run.stages()) names.push_back(row.name);
    return names;
  }

  test::TemporaryFolder folder;
  PreprocessingRequest request;
  Preprocessing run;
};

using Names = std::vector<std::string>;

TEST_F(PreprocessingRun, WritesWhatTheCommandWrites) {
  grow(3000);
  start_and_finish();
  ASSERT_EQ(run.state(), Preprocessing::State::done) << run.problem().toStdString();
  EXPECT_EQ(files(), (Names{"d.crb", "d.dat"}));
  EXPECT_EQ(run.written(), Names{folder.file("d.crb")});
  const cli::PreprocessedFile by_command =
      cli::preprocess_file({request.input, folder.file("command.crb")}, request.settings, no_progress());
  Material ours = read_material(folder.file("d.crb"));
  Material theirs = read_material(folder.file("command.crb"));
  EXPECT_EQ(ours.provenance.options, theirs.provenance.options);
  EXPECT_EQ(ours.provenance.counts, theirs.provenance.counts);
  // But for the times they are the same bytes.
  ours.provenance.stages.clear();
  theirs.provenance.stages.clear();
  write_material(folder.file("a.crb"), ours);
  write_material(folder.file("b.crb"), theirs);
  EXPECT_EQ(test::read_bytes(folder.file("a.crb")), test::read_bytes(folder.file("b.crb")));

  const Document& document = *run.document();
  EXPECT_EQ(document.kind, FileKind::atoms);
  EXPECT_EQ(document.path, request.input);
  EXPECT_TRUE(covers(document.parts, {}));
  EXPECT_EQ(document.material->mesh.tetrahedra, by_command.material.mesh.tetrahedra);
  EXPECT_EQ(document.material->defects.vacancies.size(), 2U);
  ASSERT_TRUE(document.pipeline);
  EXPECT_EQ(document.pipeline->unit_cell_source, "file");
  EXPECT_EQ(document.times.size(), run.stages().size());
}

TEST_F(PreprocessingRun, TellsOfEveryStageAsItGoes) {
  grow(3000);
  QSignalSpy ended_stages(&run, &Preprocessing::stage_ended);
  std::vector<double> fractions;
  QObject::connect(&run, &Preprocessing::progressed, &run, [&](double fraction) { fractions.push_back(fraction); });
  Names order;
  QObject::connect(&run, &Preprocessing::began, &run, [&] { order.emplace_back("began"); });
  QObject::connect(&run, &Preprocessing::stage_began, &run,
                   [&](const QString& s) { order.push_back(s.toStdString()); });
  QObject::connect(&run, &Preprocessing::stage_ended, &run, [&](const StageRow& r) { order.push_back(r.name + "."); });
  QObject::connect(&run, &Preprocessing::done, &run, [&] { order.emplace_back("done"); });
  request.format = OutputFormat::both;
  const Names stages{"read_atoms",       "find_unit_cell", "tetrahedralize", "carve",         "extract_surface",
                     "quantify_defects", "measure",        "write_material", "write_material"};
  EXPECT_EQ(planned_stages(request), stages);
  start_and_finish();
  EXPECT_EQ(stage_names(), stages);
  EXPECT_EQ(ended_stages.size(), 9);
  EXPECT_EQ(files(), (Names{"d.crb", "d.crt", "d.dat"}));
  EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
  EXPECT_EQ(fractions.back(), 1.0);
  EXPECT_EQ(order.front(), "began");
  EXPECT_EQ(order.back(), "done");
  const auto place = [&](const std::string& what) { return std::find(order.begin(), order.end(), what); };
  for (std::size_t i = 0; i + 2 < stages.size(); ++i) {
    ASSERT_NE(place(stages[i]), order.end()) << stages[i];
    EXPECT_LT(place(stages[i]), place(stages[i] + ".")) << stages[i];
    EXPECT_LT(place(stages[i] + "."), place(stages[i + 1] + ".")) << stages[i];
  }
  EXPECT_EQ(run.stages()[0].outcome, "2,998 atoms, dat; 0 skipped, 0 duplicates");
  EXPECT_NE(run.stages()[4].outcome.find(", closed"), std::string::npos) << run.stages()[4].outcome;
  for (const StageRow& row : run.stages()) {
    EXPECT_GE(row.ms, 0.0);
    EXPECT_GT(row.memory, 0U);
  }
}

TEST_F(PreprocessingRun, SavesWhereAndWhatIsAskedFor) {
  grow(3000);
  request.format = OutputFormat::none;
  start_and_finish();
  EXPECT_EQ(files(), Names{"d.dat"});
  EXPECT_TRUE(run.document());
  request.format = OutputFormat::text;
  request.output = folder.file("other.name");
  start_and_finish();
  EXPECT_EQ(files(), (Names{"d.dat", "other.name.crt"}));
  EXPECT_EQ(default_output("/a/b.c/x.y.dump"), "/a/b.c/x.y");
}

TEST_F(PreprocessingRun, LeavesWhatIsThereWhenItMay) {
  grow(3000);
  folder.file("d.crb", "mine");
  EXPECT_EQ(existing_outputs(request), Names{folder.file("d.crb")});
  request.replace = false;
  QSignalSpy notes(&run, &Preprocessing::noted);
  start_and_finish();
  EXPECT_EQ(run.state(), Preprocessing::State::done);
  EXPECT_EQ(test::read_bytes(folder.file("d.crb")), "mine");
  EXPECT_TRUE(run.written().empty());
  ASSERT_FALSE(notes.empty());
  EXPECT_TRUE(notes.back()[0].toString().contains("d.crb"));
  ASSERT_FALSE(run.document()->notes.empty());
  EXPECT_NE(run.document()->notes.back().find("d.crb"), std::string::npos);
}

TEST_F(PreprocessingRun, ABadFileIsSaidWithItsLine) {
  request.input = folder.file("bad.dat", "Na 0 0 0\nNa 1 x 0\n");
  EXPECT_EQ(problem_with(request), "");  // which only reading can tell
  start_and_finish();
  EXPECT_EQ(run.state(), Preprocessing::State::failed);
  EXPECT_TRUE(run.problem().contains("bad.dat:2")) << run.problem().toStdString();
  EXPECT_EQ(files(), Names{"bad.dat"});
  EXPECT_FALSE(run.document());
  grow(3000);  // and the next one works
  start_and_finish();
  EXPECT_EQ(run.state(), Preprocessing::State::done);
}

TEST_F(PreprocessingRun, WhatCannotBeWrittenIsSaidAndTheMaterialIsThere) {
  grow(3000);
  const std::string locked = folder.file("locked");
  std::filesystem::create_directory(locked);
  request.output = locked + "/d";
  EXPECT_EQ(problem_with(request), "");
  std::filesystem::remove(locked);  // between the question and the writing
  EXPECT_TRUE(problem_with(request).contains("locked")) << problem_with(request).toStdString();
  start_and_finish();
  EXPECT_EQ(run.state(), Preprocessing::State::done);
  EXPECT_TRUE(run.problem().contains("locked")) << run.problem().toStdString();
  EXPECT_TRUE(run.document());
  request.input = folder.file("nobody.dat");
  EXPECT_TRUE(problem_with(request).contains("nobody.dat"));
}

TEST_F(PreprocessingRun, CancelledItLeavesNothingAndTheOldFileStays) {
  grow(20'000);
  folder.file("d.crb", "old");
  for (const std::string stage : {"read_atoms", "tetrahedralize", "quantify_defects"}) {
    bool cancelled = false;
    const auto connection = QObject::connect(&run, &Preprocessing::stage_began, &run, [&](const QString& began) {
      if (began.toStdString() != stage) return;
      run.cancel();
      cancelled = true;
    });
    start_and_finish();
    QObject::disconnect(connection);
    EXPECT_TRUE(cancelled) << stage;
    EXPECT_EQ(run.state(), Preprocessing::State::cancelled) << stage;
    EXPECT_FALSE(run.document());
    EXPECT_EQ(files(), (Names{"d.crb", "d.dat"}));
    EXPECT_EQ(test::read_bytes(folder.file("d.crb")), "old");
  }
}

TEST_F(PreprocessingRun, CancelledWhileWritingItLeavesNothing) {
  grow(20'000);
  request.format = OutputFormat::both;
  QObject::connect(&run, &Preprocessing::stage_ended, &run, [&](const StageRow& row) {
    if (row.name == "write_material") run.cancel();  // the .crb is there, the .crt is being written
  });
  start_and_finish();
  if (run.state() == Preprocessing::State::done) GTEST_SKIP() << "it was faster than we";
  EXPECT_EQ(files(), Names{"d.dat"});
}

TEST_F(PreprocessingRun, DeletedWhileItRunsItIsSilentAndLeavesNothing) {
  grow(20'000);
  auto other = std::make_unique<Preprocessing>();
  QSignalSpy begun(other.get(), &Preprocessing::stage_began);
  other->start(request);
  ASSERT_TRUE(wait_until([&] { return !begun.empty(); }));
  other.reset();
  EXPECT_TRUE(wait_until([] { return !Job::any_left(); }));
  EXPECT_EQ(files(), Names{"d.dat"});
}

TEST_F(PreprocessingRun, AnswersACancelWithin200Milliseconds) {
  grow(200'000);
  start_and_finish();
  std::vector<std::string> stages = stage_names();
  std::vector<std::string> mesher_stages{"tetrahedralize"};
  double worst = 0.0;
  std::string where;
  const auto measure = [&](const std::string& mesher, const std::string& stage, double late) {
    request.settings.options.tetrahedralize.mesher = mesher;
    QElapsedTimer watch;
    bool asked = false;
    const auto ask = [&](const QString& began) {
      if (asked || began.toStdString() != stage) return;
      asked = true;
      watch.start();
      run.cancel();
    };
    QMetaObject::Connection connection;
    if (late == 0.0) {
      connection = QObject::connect(&run, &Preprocessing::stage_began, &run, ask);
    } else {
      connection = QObject::connect(&run, &Preprocessing::progressed, &run, [&](double) {
        if (run.running_stage() == stage) ask(QString::fromStdString(stage));
      });
    }
    start_and_finish();
    QObject::disconnect(connection);
    if (run.state() != Preprocessing::State::cancelled) return;  // it was over before
    const double ms = static_cast<double>(watch.nsecsElapsed()) * 1e-6;
    if (ms > worst) {
      worst = ms;
      where = mesher + " " + stage;
    }
    EXPECT_LT(ms, 200.0 * slowdown) << mesher << " " << stage;
  };
  for (const std::string& stage : stages) {
    measure("auto", stage, 0.0);
    measure("auto", stage, 1.0);
  }
  measure("delaunay", "tetrahedralize", 0.0);
  measure("delaunay", "tetrahedralize", 1.0);
  measure("tetgen", "tetrahedralize", 0.0);
  // In the midst of TetGen's own run, which knows no cancel: nothing tells when that is but the clock. Of a smaller
  // sample, for it goes on to its end.
  grow(30'000);
  QTimer in_midst;
  in_midst.setSingleShot(true);
  QElapsedTimer watch;
  QObject::connect(&in_midst, &QTimer::timeout, &run, [&] {
    watch.start();
    run.cancel();
  });
  QObject::connect(&run, &Preprocessing::stage_began, &in_midst, [&](const QString& stage) {
    if (stage == "tetrahedralize") in_midst.start(150);
  });
  start_and_finish();
  if (run.state() == Preprocessing::State::cancelled) {
    std::printf("in the midst of TetGen's run: %lld ms%s\n", static_cast<long long>(watch.elapsed()),
                Job::any_left() ? ", which goes on by itself" : "");
    EXPECT_LT(static_cast<double>(watch.elapsed()), 200.0 * slowdown);
  }
  std::printf("the longest answer to a cancel: %.0f ms, in %s\n", worst, where.c_str());
  // TetGen's own run, which stands back behind whatever else the machine does.
  EXPECT_TRUE(wait_until([] { return !Job::any_left(); }, 600'000));
  EXPECT_EQ(files(), (Names{"d.crb", "d.dat"}));
}

TEST_F(PreprocessingRun, TheWindowAnswersWithin50MillisecondsMeanwhile) {
  grow(200'000);
  request.format = OutputFormat::both;
  run.start(request);
  QElapsedTimer watch;
  std::vector<double> gaps;
  QTimer ticks;
  ticks.setTimerType(Qt::PreciseTimer);
  QObject::connect(&ticks, &QTimer::timeout, &run, [&] {
    gaps.push_back(static_cast<double>(watch.nsecsElapsed()) * 1e-6);
    watch.start();
  });
  watch.start();
  ticks.start(5);
  while (!ended()) QCoreApplication::processEvents(QEventLoop::WaitForMoreEvents | QEventLoop::AllEvents);
  ASSERT_EQ(run.state(), Preprocessing::State::done);
  const double longest = *std::max_element(gaps.begin(), gaps.end());
  std::printf("%zu events in %.0f ms, the longest gap %.1f ms\n", gaps.size(),
              run.document()->times.empty() ? 0.0 : std::accumulate(gaps.begin(), gaps.end(), 0.0), longest);
  EXPECT_GT(gaps.size(), 20U);
  EXPECT_LT(longest, 50.0 * slowdown + 5.0);  // the event and what it waited for
}

TEST(PipelineSettings, AreTheCommandLines) {
  const auto& settings = pipeline_settings();
  const auto find = [&](const std::string& name) -> const PipelineSetting& {
    return *std::find_if(settings.begin(), settings.end(), [&](const auto& s) { return s.name == name; });
  };
  EXPECT_GE(settings.size(), 15U);
  for (const PipelineSetting& setting : settings) {
    EXPECT_FALSE(setting.help.empty()) << setting.name;
    EXPECT_FALSE(setting.group.empty()) << setting.name;
    // The text that stands for the default is the default.
    if (setting.initial.empty() || setting.name == "format" || setting.name == "simplify-by") continue;
    EXPECT_NO_THROW(pipeline_options({{setting.name, setting.initial}})) << setting.name;
  }
  EXPECT_EQ(find("carve").initial, "auto");
  EXPECT_EQ(find("carve").label, "Carve");
  EXPECT_EQ(find("unit-cell").choices, (Names{"auto", "found", "none"}));
  EXPECT_TRUE(find("unit-cell").file);
  EXPECT_EQ(find("mesher").choices, mesher_names());
  EXPECT_FALSE(find("mesher").open);
  EXPECT_EQ(find("neighbourhood").initial, "1");
}

TEST(PipelineSettings, ComeBackFromWhatWasRecorded) {
  const PipelineValues values{{"carve", "2.6"},          {"unit-cell", "none"}, {"keep-every", "7"}, {"format", "xyz"},
                              {"simplify-by", "remove"}, {"noise", "0.05"},     {"mask", "As,Ga"}};
  EXPECT_EQ(recorded_values(provenance_options(pipeline_options(values), "xyz")), values);
  EXPECT_EQ(recorded_values(provenance_options({}, "")), PipelineValues{});
}

TEST(PipelineSettings, BecomeOptions) {
  const PipelineOptions defaults = pipeline_options({});
  EXPECT_EQ(provenance_options(defaults, ""), provenance_options({}, ""));
  const PipelineOptions options =
      pipeline_options({{"carve", "3.5"}, {"mesher", "delaunay"}, {"type-names", "Cu,Zn"}, {"simplify-by", "remove"}});
  EXPECT_EQ(options.carve_options.radius, 3.5);
  EXPECT_EQ(options.tetrahedralize.mesher, "delaunay");
  EXPECT_EQ(options.read.type_names, (Names{"Cu", "Zn"}));
  EXPECT_TRUE(options.simplify);
  EXPECT_EQ(options.simplify_options.strategy, "remove");
  EXPECT_FALSE(pipeline_options({{"carve", "off"}}).carve);
  EXPECT_THROW(pipeline_options({{"carve", "wide"}}), UsageError);
  EXPECT_THROW(pipeline_options({{"frame", "1.5"}}), UsageError);
  EXPECT_THROW(pipeline_options({{"keep-every", "0"}}), UsageError);
  EXPECT_THROW(pipeline_options({{"no-such", "1"}}), UsageError);
}

}  // namespace
