#include "app/gui/file_summary.h"

#include <sys/stat.h>
#include <unistd.h>

#include <QCoreApplication>
#include <QFileInfo>
#include <algorithm>
#include <cerrno>
#include <cstring>
#include <map>

#include "app/cli/text_table.h"
#include "core/error.h"
#include "core/text_file.h"
#include "preprocess/read_atoms.h"

namespace atomesh::gui {

namespace {

QString translated(const char* sentence) {
  return QCoreApplication::translate("FileSummary", sentence);
}

using Counts = std::map<std::string, std::uint64_t>;

// From the table of sections, whose lengths are known.
Counts counts_of_crb(const std::string& path) {
  std::map<std::string, std::uint64_t> bytes;
  for (const SectionInfo& section : list_sections(path)) bytes[section.name] = section.bytes;
  return {{"atoms", bytes["positions"] / 24},
          {"tetrahedra", bytes["tetrahedra"] / 16},
          {"triangles", bytes["surface"] / 12}};
}

// From the counts of its provenance, which stand at its head.
Counts counts_of_crt(std::string_view bytes) {
  Counts counts;
  LineReader lines(bytes.substr(0, 1U << 16U));
  std::string_view line;
  while (lines.next(line)) {
    const std::vector<std::string_view> fields = split_fields(line);
    std::int64_t count = 0;
    if (fields.size() == 3 && fields[0] == "count" && fields[1].size() > 2 && parse_integer(fields[2], count)) {
      counts[std::string(fields[1].substr(1, fields[1].size() - 2))] = static_cast<std::uint64_t>(count);
    }
    if (!fields.empty() && fields[0] == "atoms") break;
  }
  return counts;
}

// Where the format says it at its head: XYZ in the first line, LAMMPS data in "N atoms", a dump after its ITEM.
std::optional<std::uint64_t> atoms_at_head(std::string_view bytes) {
  LineReader lines(bytes.substr(0, 4096));
  std::string_view line;
  bool number_of_atoms = false;
  while (lines.next(line) && lines.line_number() < 40) {
    const std::vector<std::string_view> fields = split_fields(line);
    if (fields.empty()) continue;
    std::int64_t count = 0;
    const bool counts = parse_integer(fields[0], count) && count >= 0;
    const bool alone = fields.size() == 1 && (number_of_atoms || lines.line_number() == 1);
    if (counts && (alone || (fields.size() == 2 && fields[1] == "atoms"))) return static_cast<std::uint64_t>(count);
    number_of_atoms = line == "ITEM: NUMBER OF ATOMS";
  }
  return std::nullopt;
}

QString counted(const Counts& counts) {
  QStringList parts;
  for (const char* what : {"atoms", "tetrahedra", "triangles"}) {
    const auto found = counts.find(what);
    if (found == counts.end() || found->second == 0) continue;
    parts << QString::fromStdString(cli::grouped(found->second)) + ' ' + translated(what);
  }
  return parts.join(", ");
}

QString describe(const std::string& path, FileKind kind, std::uint64_t size) {
  const QString ending = QFileInfo(QString::fromStdString(path)).suffix().toLower();
  const QString bytes = QString::fromStdString(cli::byte_size(size));
  switch (kind) {
    case FileKind::material: {
      const MappedFile file(path);
      const bool binary = file.bytes().starts_with("ATOMESH");
      const QString counts = counted(binary ? counts_of_crb(path) : counts_of_crt(file.bytes()));
      return translated("Material (%1)%2; %3")
          .arg(binary ? ".crb" : ".crt", counts.isEmpty() ? QString() : ": " + counts, bytes);
    }
    case FileKind::mesh:
      return translated("Mesh (.%1); %2").arg(ending, bytes);
    case FileKind::picture:
      return translated("Picture; %1").arg(bytes);
    case FileKind::atoms:
      break;
  }
  const MappedFile file(path);
  const auto atoms = atoms_at_head(file.bytes());
  const QString counts = atoms ? counted({{"atoms", *atoms}}) : QString();
  return translated("Atoms (.%1)%2; %3").arg(ending, counts.isEmpty() ? QString() : ": " + counts, bytes);
}

}  // namespace

FileSummary summarize_file(const std::string& path) {
  FileSummary summary;
  summary.path = path;
  const QString name = QString::fromStdString(path);
  struct stat status {};
  if (::stat(path.c_str(), &status) != 0) {
    summary.problem = errno == ENOENT ? translated("there is no file %1; choose another").arg(name)
                                      : QString::fromUtf8(std::strerror(errno)) + ": " + name;
    return summary;
  }
  if (S_ISDIR(status.st_mode)) {
    summary.problem = translated("%1 is a folder; choose a file in it").arg(name);
    return summary;
  }
  if (!S_ISREG(status.st_mode)) {
    summary.problem = translated("%1 is no ordinary file; choose another").arg(name);
    return summary;
  }
  if (::access(path.c_str(), R_OK) != 0) {
    summary.problem = translated("%1 may not be read by you; ask its owner, or choose another").arg(name);
    return summary;
  }
  if (status.st_size == 0) {
    summary.problem = translated("%1 is empty; choose another").arg(name);
    return summary;
  }
  try {
    summary.kind = file_kind(path);
    summary.text = describe(path, summary.kind, static_cast<std::uint64_t>(status.st_size));
  } catch (const Error& error) {
    summary.problem = QString::fromUtf8(error.what());
  }
  return summary;
}

FileChoice choose_files(const QStringList& paths) {
  QStringList data;
  QStringList parameters;
  for (const QString& path : paths) {
    if (QFileInfo(path).isDir()) {
      return {.data = {}, .parameters = {}, .problem = translated("%1 is a folder; give a file of it").arg(path)};
    }
    (path.endsWith(".crf", Qt::CaseInsensitive) ? parameters : data) << path;
  }
  // TetGen writes one mesh into two files.
  if (data.size() == 2) {
    const QFileInfo a(data[0]);
    const QFileInfo b(data[1]);
    const QStringList endings{a.suffix(), b.suffix()};
    if (a.completeBaseName() == b.completeBaseName() && a.absolutePath() == b.absolutePath() &&
        endings.contains("node") && endings.contains("ele")) {
      data.removeLast();
    }
  }
  const auto names = [](const QStringList& list) {
    QStringList short_names;
    for (const QString& path : list.mid(0, 3)) short_names << QFileInfo(path).fileName();
    return short_names.join(", ") + (list.size() > 3 ? QStringLiteral(", …") : QString());
  };
  if (data.size() > 1) {
    return {.data = {},
            .parameters = {},
            .problem = translated("one file can be shown at a time, and these are %1: %2; give one of them")
                           .arg(data.size())
                           .arg(names(data))};
  }
  if (parameters.size() > 1) {
    return {.data = {},
            .parameters = {},
            .problem = translated("one .crf can hold at a time, and these are %1: %2; give one of them")
                           .arg(parameters.size())
                           .arg(names(parameters))};
  }
  return {.data = data.value(0), .parameters = parameters.value(0), .problem = {}};
}

}  // namespace atomesh::gui
