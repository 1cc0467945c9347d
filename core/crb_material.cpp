#include "core/crb_material.h"

#include <algorithm>
#include <array>
#include <deque>

#include "core/check_material.h"
#include "core/crb_bytes.h"
#include "core/crb_container.h"
#include "core/error.h"

namespace atomesh {

namespace {

// ---- writing

bool is_identity(const std::vector<Index>& indices) {
  for (std::size_t i = 0; i < indices.size(); ++i) {
    if (indices[i] != i) return false;
  }
  return true;
}

CrbCounts crb_counts(const Material& m) {
  const auto same_bits = [](const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3)) == 0);
  };
  std::uint64_t flags = 0;
  if (m.unit_cell) flags |= crb_has_unit_cell;
  if (!m.atoms.ids.empty()) flags |= crb_has_ids;
  if (same_bits(m.mesh.vertices, m.atoms.positions)) flags |= crb_vertices_are_positions;
  if (is_identity(m.mesh.vertex_atom)) flags |= crb_vertex_atoms_are_identity;
  if (!m.surface.tetrahedron.empty()) flags |= crb_has_surface_cells;
  if (m.defects.present()) flags |= crb_has_defects;
  if (m.mesh.delaunay) flags |= crb_delaunay;
  return {m.atoms.size(),
          m.atoms.species_table.size(),
          m.atoms.columns.size(),
          m.mesh.vertices.size(),
          m.mesh.tetrahedra.size(),
          m.surface.triangles.size(),
          m.defects.vacancies.size(),
          m.defects.extras.size(),
          flags,
          m.defects.substitutions.size(),
          m.fields.size()};
}

ByteWriter species_bytes(const Material& m) {
  ByteWriter bytes;
  for (const Species& species : m.atoms.species_table) {
    bytes.string(species.name);
    bytes.value(species.radius);
  }
  return bytes;
}

ByteWriter box_bytes(const Box& box) {
  ByteWriter bytes;
  bytes.value(box.origin);
  for (const Vec3& vector : box.vectors) bytes.value(vector);
  for (const bool periodic : box.periodic) bytes.value(static_cast<std::uint8_t>(periodic));
  return bytes;
}

ByteWriter unit_cell_bytes(const UnitCell& cell) {
  ByteWriter bytes;
  for (const Vec3& vector : cell.primitive) bytes.value(vector);
  bytes.count(cell.basis.size());
  for (const BasisAtom& atom : cell.basis) {
    bytes.string(atom.species);
    bytes.value(atom.position);
  }
  return bytes;
}

ByteWriter provenance_bytes(const Provenance& provenance) {
  ByteWriter bytes;
  bytes.string(provenance.program);
  bytes.string(provenance.input);
  bytes.count(provenance.options.size());
  for (const auto& [name, value] : provenance.options) {
    bytes.string(name);
    bytes.string(value);
  }
  bytes.count(provenance.counts.size());
  for (const auto& [name, value] : provenance.counts) {
    bytes.string(name);
    bytes.value(value);
  }
  bytes.count(provenance.stages.size());
  for (const StageTime& stage : provenance.stages) {
    bytes.string(stage.name);
    bytes.value(stage.ms);
  }
  return bytes;
}

// The sections a material has, in file order. What has to be put together first is kept in `owned`.
class Sections {
 public:
  struct Section {
    std::string_view name;
    std::span<const std::byte> bytes;
    std::size_t element;
  };

  explicit Sections(const Material& m) {
    const CrbCounts counts = crb_counts(m);
    ByteWriter count_bytes;
    count_bytes.value(counts);
    add("counts", std::move(count_bytes));
    add("species", species_bytes(m));
    add("box", box_bytes(m.atoms.box));
    if (m.unit_cell) add("unit cell", unit_cell_bytes(*m.unit_cell));
    add("positions", m.atoms.positions, 8);
    add("atom species", m.atoms.species, 2);
    add("ids", m.atoms.ids, 8);
    add_columns(m.atoms.columns);
    if ((counts.flags & crb_vertices_are_positions) == 0) add("vertices", m.mesh.vertices, 8);
    if ((counts.flags & crb_vertex_atoms_are_identity) == 0) add("vertex atoms", m.mesh.vertex_atom, 4);
    add("tetrahedra", m.mesh.tetrahedra, 4);
    add("surface", m.surface.triangles, 4);
    add("surface cells", m.surface.tetrahedron, 4);
    add("surface faces", m.surface.face, 1);
    if (m.defects.present()) {
      ByteWriter bytes;
      for (const auto* values : {&m.defects.positional, &m.defects.vacancy, &m.defects.extra}) {
        bytes.values(*values);
      }
      add("defects", std::move(bytes), 4);
    }
    add_sites(m.defects);
    add_fields(m.fields);
    add("provenance", provenance_bytes(m.provenance));
  }

  const std::vector<Section>& list() const { return list_; }
  std::uint64_t total() const {
    std::uint64_t sum = 0;
    for (const Section& section : list_) sum += section.bytes.size();
    return sum;
  }

 private:
  template <class T>
  void add(std::string_view name, const std::vector<T>& values, std::size_t element) {
    if (!values.empty()) list_.push_back({name, std::as_bytes(std::span(values)), element});
  }
  void add(std::string_view name, ByteWriter bytes, std::size_t element = 1) {
    owned_.push_back(std::move(bytes));
    list_.push_back({name, owned_.back().bytes(), element});
  }
  void add_columns(const std::vector<Column>& columns) {
    if (columns.empty()) return;
    ByteWriter names;
    ByteWriter values;
    for (const Column& column : columns) {
      names.string(column.name);
      values.values(column.values);
    }
    add("scalar names", std::move(names));
    add("scalars", std::move(values), 8);
  }
  void add_fields(const std::vector<VertexField>& fields) {
    if (fields.empty()) return;
    ByteWriter names;
    ByteWriter values;
    for (const VertexField& field : fields) {
      names.string(field.name);
      values.values(field.values);
    }
    add("field names", std::move(names));
    if (!fields.front().values.empty()) add("fields", std::move(values), 4);
  }
  void add_sites(const Defects& defects) {
    ByteWriter vacancies;
    for (const VacancySite& site : defects.vacancies) {
      vacancies.value(site.position);
      vacancies.value(static_cast<std::uint32_t>(site.species));
      vacancies.value(site.votes);
    }
    if (!defects.vacancies.empty()) add("vacancies", std::move(vacancies));
    ByteWriter extras;
    for (const ExtraAtom& extra : defects.extras) {
      extras.value(extra.atom);
      extras.value(extra.votes);
    }
    if (!defects.extras.empty()) add("extras", std::move(extras));
    ByteWriter substitutions;
    for (const Substitution& substitution : defects.substitutions) {
      substitutions.value(substitution.atom);
      substitutions.value(static_cast<std::uint32_t>(substitution.expected));
      substitutions.value(substitution.vacancy);
    }
    if (!defects.substitutions.empty()) add("substitutions", std::move(substitutions));
  }

  std::deque<ByteWriter> owned_;
  std::vector<Section> list_;
};

// ---- reading

class MaterialReader {
 public:
  MaterialReader(const CrbReader& file, const MaterialParts& parts, Progress& progress)
      : file_(file), parts_(parts), progress_(progress) {}

  Material read() {
    read_counts();
    const bool mesh = parts_.tetrahedra || parts_.surface;
    // Each step reads some sections; the progress counts their bytes.
    using Step = void (MaterialReader::*)();
    const std::array<std::pair<bool, Step>, 7> steps{{{true, &MaterialReader::read_small},
                                                      {parts_.atoms, &MaterialReader::read_atoms},
                                                      {mesh, &MaterialReader::read_vertices},
                                                      {parts_.tetrahedra, &MaterialReader::read_tetrahedra},
                                                      {parts_.surface, &MaterialReader::read_surface},
                                                      {parts_.defects, &MaterialReader::read_defects},
                                                      {mesh && parts_.fields, &MaterialReader::read_fields}}};
    double done = 0.0;
    for (const auto& [wanted, step] : steps) {
      if (wanted) (this->*step)();
      progress_.update(++done / static_cast<double>(steps.size() + 1));
    }
    if (const auto problem = find_problem(m_, {counts_.atoms, counts_.vertices, counts_.tetrahedra}, progress_)) {
      file_.fail(problem->section, problem->what);
    }
    progress_.update(1.0);
    return std::move(m_);
  }

 private:
  bool has(std::uint64_t flag) const { return (counts_.flags & flag) != 0; }

  template <class T>
  std::vector<T> array(std::string_view section, std::uint64_t count) {
    return count == 0 ? std::vector<T>() : file_.read_array<T>(section, count, progress_);
  }

  void read_counts() {
    ByteReader bytes(file_, "counts", progress_);
    const auto since_1 = bytes.value<std::array<std::byte, crb_counts_size_1>>();
    std::memcpy(&counts_, since_1.data(), since_1.size());
    if (file_.version() > 1) counts_.substitutions = bytes.value<std::uint64_t>();
    if (file_.version() > 2) counts_.fields = bytes.value<std::uint64_t>();
    bytes.finish();
    for (const std::uint64_t count : {counts_.atoms, counts_.vertices, counts_.tetrahedra, counts_.triangles}) {
      if (count >= no_index) file_.fail("counts", "more than 4,294,967,294 of something");
    }
    if ((counts_.flags & ~crb_all_flags) != 0) file_.fail("counts", "a flag this program does not know");
    const bool vertices_fit = !has(crb_vertices_are_positions) || counts_.vertices == counts_.atoms;
    const bool atoms_fit = !has(crb_vertex_atoms_are_identity) || counts_.vertices <= counts_.atoms;
    if (!vertices_fit || !atoms_fit) file_.fail("counts", "the numbers of atoms and vertices contradict the flags");
    check_table();
  }

  // The file has the sections its counts call for, and no others.
  void check_table() const {
    const std::array<std::pair<const char*, bool>, 22> sections{{
        {"counts", true},
        {"species", true},
        {"box", true},
        {"unit cell", has(crb_has_unit_cell)},
        {"positions", counts_.atoms > 0},
        {"atom species", counts_.atoms > 0},
        {"ids", has(crb_has_ids)},
        {"scalar names", counts_.columns > 0},
        {"scalars", counts_.columns > 0},
        {"vertices", counts_.vertices > 0 && !has(crb_vertices_are_positions)},
        {"vertex atoms", counts_.vertices > 0 && !has(crb_vertex_atoms_are_identity)},
        {"tetrahedra", counts_.tetrahedra > 0},
        {"surface", counts_.triangles > 0},
        {"surface cells", has(crb_has_surface_cells)},
        {"surface faces", has(crb_has_surface_cells)},
        {"defects", has(crb_has_defects)},
        {"vacancies", counts_.vacancies > 0},
        {"extras", counts_.extras > 0},
        {"substitutions", counts_.substitutions > 0},
        {"field names", counts_.fields > 0},
        {"fields", counts_.fields > 0 && counts_.vertices > 0},
        {"provenance", true},
    }};
    auto next = file_.table().begin();
    for (const auto& [name, present] : sections) {
      if (!present) continue;
      if (next == file_.table().end() || CrbReader::name(*next) != name) file_.fail(name, "is missing");
      ++next;
    }
    if (next != file_.table().end()) file_.fail(CrbReader::name(*next), "is not called for by the counts");
  }

  void read_small() {
    ByteReader species(file_, "species", progress_);
    for (std::uint64_t i = 0; i < counts_.species; ++i) {
      std::string name = species.string();
      m_.atoms.species_table.push_back({std::move(name), species.value<double>()});
    }
    species.finish();
    if (has(crb_has_unit_cell)) {
      ByteReader bytes(file_, "unit cell", progress_);
      UnitCell& cell = m_.unit_cell.emplace();
      for (Vec3& vector : cell.primitive) vector = bytes.value<Vec3>();
      cell.basis.resize(bytes.count(sizeof(std::uint32_t) + sizeof(Vec3)));
      for (BasisAtom& atom : cell.basis) {
        atom.species = bytes.string();
        atom.position = bytes.value<Vec3>();
      }
      bytes.finish();
    }
    m_.mesh.delaunay = has(crb_delaunay);
    read_provenance();
  }

  void read_provenance() {
    ByteReader bytes(file_, "provenance", progress_);
    Provenance& provenance = m_.provenance;
    provenance.program = bytes.string();
    provenance.input = bytes.string();
    provenance.options.resize(bytes.count(8));
    for (auto& [name, value] : provenance.options) {
      name = bytes.string();
      value = bytes.string();
    }
    provenance.counts.resize(bytes.count(12));
    for (auto& [name, value] : provenance.counts) {
      name = bytes.string();
      value = bytes.value<std::uint64_t>();
    }
    provenance.stages.resize(bytes.count(12));
    for (StageTime& stage : provenance.stages) {
      stage.name = bytes.string();
      stage.ms = bytes.value<double>();
    }
    bytes.finish();
  }

  void read_atoms() {
    ByteReader bytes(file_, "box", progress_);
    Box& box = m_.atoms.box;
    box.origin = bytes.value<Vec3>();
    for (Vec3& vector : box.vectors) vector = bytes.value<Vec3>();
    for (bool& periodic : box.periodic) {
      const auto value = bytes.value<std::uint8_t>();
      if (value > 1) file_.fail("box", "an axis that is neither periodic nor open");
      periodic = value == 1;
    }
    bytes.finish();
    m_.atoms.positions = array<Vec3>("positions", counts_.atoms);
    m_.atoms.species = array<std::uint16_t>("atom species", counts_.atoms);
    if (has(crb_has_ids)) m_.atoms.ids = array<std::int64_t>("ids", counts_.atoms);
    if (counts_.columns > 0) read_columns();
  }

  void read_columns() {
    ByteReader names(file_, "scalar names", progress_);
    for (std::uint64_t i = 0; i < counts_.columns; ++i) m_.atoms.columns.push_back({names.string(), {}});
    names.finish();
    // The names have been there, so the number of columns is no more than a few bytes each; the product cannot
    // overflow.
    const std::vector<double> values = file_.read_array<double>("scalars", counts_.columns * counts_.atoms, progress_);
    for (std::size_t i = 0; i < m_.atoms.columns.size(); ++i) {
      const auto begin = values.begin() + static_cast<std::ptrdiff_t>(i * counts_.atoms);
      m_.atoms.columns[i].values.assign(begin, begin + static_cast<std::ptrdiff_t>(counts_.atoms));
    }
  }

  void read_vertices() {
    if (!has(crb_vertices_are_positions)) {
      m_.mesh.vertices = array<Vec3>("vertices", counts_.vertices);
    } else if (parts_.atoms) {
      m_.mesh.vertices = m_.atoms.positions;
    } else {
      m_.mesh.vertices = array<Vec3>("positions", counts_.vertices);
    }
    if (!has(crb_vertex_atoms_are_identity)) {
      m_.mesh.vertex_atom = array<Index>("vertex atoms", counts_.vertices);
      return;
    }
    m_.mesh.vertex_atom.resize(m_.mesh.vertices.size());
    for (std::size_t i = 0; i < m_.mesh.vertex_atom.size(); ++i) m_.mesh.vertex_atom[i] = static_cast<Index>(i);
  }

  void read_tetrahedra() { m_.mesh.tetrahedra = array<Tetrahedron>("tetrahedra", counts_.tetrahedra); }

  void read_surface() {
    m_.surface.triangles = array<Triangle>("surface", counts_.triangles);
    if (!has(crb_has_surface_cells) || !parts_.tetrahedra) return;
    m_.surface.tetrahedron = array<Index>("surface cells", counts_.triangles);
    m_.surface.face = array<std::uint8_t>("surface faces", counts_.triangles);
  }

  void read_defects() {
    Defects& defects = m_.defects;
    if (has(crb_has_defects)) {
      const std::vector<float> values = array<float>("defects", 3 * counts_.atoms);
      const auto count = static_cast<std::ptrdiff_t>(counts_.atoms);
      defects.positional.assign(values.begin(), values.begin() + count);
      defects.vacancy.assign(values.begin() + count, values.begin() + 2 * count);
      defects.extra.assign(values.begin() + 2 * count, values.end());
    }
    if (counts_.vacancies > 0) {
      ByteReader bytes(file_, "vacancies", progress_);
      for (std::uint64_t i = 0; i < counts_.vacancies; ++i) {
        VacancySite site{};
        site.position = bytes.value<Vec3>();
        const auto species = bytes.value<std::uint32_t>();
        if (species > 65535) file_.fail("vacancies", "a species that is not in the table");
        site.species = static_cast<std::uint16_t>(species);
        site.votes = bytes.value<std::uint32_t>();
        defects.vacancies.push_back(site);
      }
      bytes.finish();
    }
    if (counts_.extras > 0) {
      ByteReader bytes(file_, "extras", progress_);
      for (std::uint64_t i = 0; i < counts_.extras; ++i) {
        ExtraAtom extra{};
        extra.atom = bytes.value<std::uint32_t>();
        extra.votes = bytes.value<std::uint32_t>();
        defects.extras.push_back(extra);
      }
      bytes.finish();
    }
    if (counts_.substitutions > 0) {
      ByteReader bytes(file_, "substitutions", progress_);
      for (std::uint64_t i = 0; i < counts_.substitutions; ++i) {
        Substitution substitution{};
        substitution.atom = bytes.value<std::uint32_t>();
        const auto expected = bytes.value<std::uint32_t>();
        if (expected > 65535) file_.fail("substitutions", "a species that is not in the table");
        substitution.expected = static_cast<std::uint16_t>(expected);
        substitution.vacancy = bytes.value<std::uint32_t>();
        defects.substitutions.push_back(substitution);
      }
      bytes.finish();
    }
  }

  void read_fields() {
    if (counts_.fields == 0) return;
    ByteReader names(file_, "field names", progress_);
    for (std::uint64_t i = 0; i < counts_.fields; ++i) m_.fields.push_back({names.string(), {}});
    names.finish();
    if (counts_.vertices == 0) return;
    // As with the columns: the names have been there, so the product cannot overflow.
    const std::vector<float> values = array<float>("fields", counts_.fields * counts_.vertices);
    for (std::size_t i = 0; i < m_.fields.size(); ++i) {
      const auto first = values.begin() + static_cast<std::ptrdiff_t>(i * counts_.vertices);
      m_.fields[i].values.assign(first, first + static_cast<std::ptrdiff_t>(counts_.vertices));
    }
  }

  const CrbReader& file_;
  const MaterialParts parts_;
  Progress& progress_;
  CrbCounts counts_{};
  Material m_;
};

}  // namespace

Material read_crb(std::string_view bytes, const std::string& path, const MaterialParts& parts, Progress& progress) {
  const CrbReader file(bytes, path);
  return MaterialReader(file, parts, progress).read();
}

void write_crb(const std::string& path, const Material& material, bool compress, Progress& progress) {
  const Sections sections(material);
  for (const bool packed : {compress, false}) {
    AtomicFile file(path);
    CrbWriter writer(file, sections.list().size(), packed, sections.total(), progress);
    for (const auto& section : sections.list()) writer.add(section.name, section.bytes, section.element);
    if (!writer.finish()) continue;
    file.commit();
    return;
  }
}

std::vector<SectionInfo> list_crb_sections(std::string_view bytes, const std::string& path) {
  const CrbReader file(bytes, path);
  std::vector<SectionInfo> sections;
  for (const CrbEntry& entry : file.table()) sections.push_back({CrbReader::name(entry), entry.raw, entry.stored});
  return sections;
}

}  // namespace atomesh
