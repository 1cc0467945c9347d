#include "app/cli/bench_lammps.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>
#include <vector>

namespace atomesh::cli {

namespace {

void write_data(const std::string& path, const Atoms& atoms) {
  std::ofstream file(path);
  file << fmt::format("atoms of a bench\n\n{} atoms\n1 atom types\n\n", atoms.size());
  const std::array<const char*, 3> names{"x", "y", "z"};
  for (int axis = 0; axis < 3; ++axis) {
    const double low = atoms.box.origin[axis];
    file << fmt::format("{} {} {}lo {}hi\n", low, low + atoms.box.vectors[static_cast<std::size_t>(axis)][axis],
                        names[static_cast<std::size_t>(axis)], names[static_cast<std::size_t>(axis)]);
  }
  file << "\nMasses\n\n1 50\n\nAtoms # atomic\n\n";
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    const Vec3& p = atoms.positions[i];
    file << fmt::format("{} 1 {} {} {}\n", i + 1, p.x, p.y, p.z);
  }
}

// Each compute with its lists kept, then with all lists built anew in every step. In each of the `calls` steps thermo
// output asks for the compute once.
std::string script(const std::string& data, double cutoff, int neighbours, int calls) {
  std::string text = fmt::format(
      "units metal\natom_style atomic\nboundary p p p\nread_data \"{}\"\n"
      "pair_style zero {}\npair_coeff * *\ncomm_modify cutoff {}\nneighbor 0.0 bin\n"
      "compute cna all cna/atom {}\ncompute cen all centro/atom {}\n"
      "compute scna all reduce sum c_cna\ncompute scen all reduce sum c_cen\nthermo 1\n",
      data, 1.05 * cutoff, 2.2 * cutoff, cutoff, neighbours);
  for (const char* lists : {"every 100000000 delay 0 check no", "every 1 delay 0 check no"}) {
    for (const char* column : {"c_scna", "c_scen"}) {
      text += fmt::format("neigh_modify {}\nthermo_style custom step {}\nrun 0\nrun {} pre no post yes\n", lists,
                          column, calls);
    }
  }
  return text;
}

std::string in_quotes(const std::string& path) {
  std::string out = "'";
  for (const char c : path) out += c == '\'' ? "'\\''" : std::string(1, c);
  return out + "'";
}

}  // namespace

std::string find_lammps() {
  const char* path = std::getenv("PATH");
  std::istringstream folders(path == nullptr ? "" : path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const std::string candidate = folder + "/lmp";
    if (!folder.empty() && access(candidate.c_str(), X_OK) == 0) return candidate;
  }
  return "";
}

std::optional<LammpsTimes> time_lammps(const std::string& lmp, const Atoms& atoms, double cutoff, int neighbours,
                                       int calls, Session& session, std::string& why) {
  const TemporaryFolder folder;
  write_data(folder.file("atoms.data"), atoms);
  std::ofstream(folder.file("in.bench")) << script(folder.file("atoms.data"), cutoff, neighbours, calls);
  const std::string command = fmt::format("OMP_NUM_THREADS=1 {} -in {} -log none 2>&1 </dev/null", in_quotes(lmp),
                                          in_quotes(folder.file("in.bench")));
  FILE* output = popen(command.c_str(), "r");
  if (output == nullptr) {
    why = "it could not be started";
    return std::nullopt;
  }
  // "Loop time of 0.848666 on 1 procs for 3 steps with 256000 atoms", then "99.1% CPU use with 1 MPI tasks"; a run of 0
  // steps only sets up.
  std::vector<Times> times;
  bool counted = false;
  std::array<char, 4096> line{};
  while (std::fgets(line.data(), static_cast<int>(line.size()), output) != nullptr) {
    why = line.data();
    double seconds = 0.0;
    double percent = 0.0;
    int steps = 0;
    if (std::sscanf(line.data(), "Loop time of %lf on %*d procs for %d steps", &seconds, &steps) == 2) {
      counted = steps > 0;
      const double ms = 1e3 * seconds / std::max(steps, 1);
      if (counted) times.push_back({ms, ms, ms, ms});
    } else if (counted && why.find("% CPU use") != std::string::npos &&
               std::sscanf(line.data(), "%lf", &percent) == 1) {
      times.back().cpu = 0.01 * percent * times.back().median;
    }
  }
  const int status = pclose(output);
  session.progress().check();
  while (!why.empty() && why.back() == '\n') why.pop_back();
  if (status != 0 || times.size() != 4) return std::nullopt;
  return LammpsTimes{times[0], times[2], times[1], times[3]};
}

}  // namespace atomesh::cli
