#include "host/case/load_case.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "host/case/element_tests.hpp"
#include "host/case/engine.hpp"
#include "host/case/grains.hpp"
#include "host/case/idle_keys.hpp"
#include "host/case/mesh.hpp"
#include "host/case/packing_origin.hpp"
#include "host/case/scene_keys.hpp"
#include "host/case/scene_names.hpp"
#include "host/case/scene_samples.hpp"
#include "host/case/tables.hpp"
#include "io/case_file.hpp"
#include "io/hash.hpp"
#include "io/text_file.hpp"

namespace voussoir::host {
namespace {

CaseKind read_kind(const io::Table& root) {
  std::vector<std::string> names;
  for (const auto& [kind, name] : case_kind_names) names.emplace_back(name);
  const std::string wanted = root.choice(
      {"kind",
       "What the case computes: packings (`pack`), responses of one packing to small strains (`probe`), biaxial tests "
       "on packings (`biaxial`) or on a mesh (`biaxial_bvp`), a search of the grains' parameters (`calibrate`), a "
       "column for K0 (`column`), a tunnel (`tunnel`), or any problem of plane strain that is said in meshes, regions, "
       "supports and stages (`scene`)."},
      names);
  for (const auto& [kind, name] : case_kind_names) {
    if (wanted == name) return kind;
  }
  throw std::logic_error("a choice that was not offered");
}

/// Reads the tables of the grains. They are allowed with any material, so that one `--set` can change the material.
void read_grain_tables(const io::Table& root, Case& input) {
  input.soil = read_soil(root.table(tables::soil));
  input.packing = read_packing(root.table(tables::packing), runs_on_a_mesh(input.kind));
  input.engine = read_engine(root.table(tables::engine), runs_on_a_mesh(input.kind));
  if (input.engine.accuracy > 0 && (input.kind == CaseKind::biaxial || input.kind == CaseKind::calibrate)) {
    throw root.known_table("engine").error(
        "accuracy", "is for RVEs that are strained in increments; tests have the rate of biaxial.inertial_number");
  }
  if (input.kind == CaseKind::probe) input.probe = read_probe(root.table(tables::probe));
  if (input.kind != CaseKind::probe) check_no_state(root.known_table("packing"), input.packing);
  if (runs_on_a_mesh(input.kind)) check_variety(root.known_table("packing"), input.packing);
  if (!runs_on_a_mesh(input.kind) && input.packing.files.size() > 1) {
    throw root.known_table("packing").error("file", "names several files, but only kinds with a mesh mix packings");
  }
  if (input.kind == CaseKind::biaxial || input.kind == CaseKind::calibrate) {
    input.biaxial = read_biaxial(root.table(tables::biaxial));
  }
  if (input.kind == CaseKind::biaxial) input.output.microstructure = read_microstructure(root.table(tables::output));
  if (input.kind == CaseKind::calibrate) input.calibrate = read_calibrate(root.table(tables::calibrate), input.soil);
}

/// Reads the tables that every kind with a mesh has.
void read_mesh_tables(const io::Table& root, Case& input) {
  const std::string material = root.choice({"material",
                                            "What the points of the mesh are made of: representative volume elements "
                                            "of grains, or the linear elastic material of `[elastic]`. A region "
                                            "with its own `[region.elastic]` keeps it in both."},
                                           {"grains", "linear_elastic"}, "grains");
  input.material = material == "grains" ? MaterialKind::grains : MaterialKind::linear_elastic;
  input.elastic = read_elastic(root.table(tables::elastic));
  input.newton = read_newton(root.table(tables::newton));
  input.output = read_output(root.table(tables::output));
  if (input.kind == CaseKind::biaxial_bvp) input.biaxial_bvp = read_biaxial_bvp(root.table(tables::biaxial_bvp));
}

void read_scene_tables(const io::Table& root, Case& input) {
  input.column = read_column(root.table(tables::column));
  input.gravity = read_gravity(root.table(tables::gravity));
  input.scene = read_scene(root, input);
}

void read_ground_tables(const io::Table& root, Case& input) {
  const bool with_tunnel = input.kind == CaseKind::tunnel;
  input.ground = read_ground(root.table(tables::ground), with_tunnel);
  input.column = read_column(root.table(tables::column));
  input.gravity = read_gravity(root.table(tables::gravity));
  if (with_tunnel) input.volume_loss = read_volume_loss(root.table(tables::volume_loss));
  if (std::abs(input.ground.surcharge - input.packing.pressure) > 1e-9 * input.packing.pressure) {
    throw root.known_table("ground").error("surcharge",
                                           "must equal packing.pressure: the ground starts at rest under it");
  }
  if (input.ground.surcharge > 0.5 * input.ground.unit_weight * input.ground.height) {
    throw root.known_table("ground").error("surcharge", "is more than half the weight of the ground");
  }
}

/// Refuses a case that asks for something that a GPU does not compute.
void check_gpu(const io::Table& root, const Case& input) {
  if (input.newton.tangent == kernels::TangentKind::loading)
    throw root.known_table("newton").error("tangent", "\"loading\" is not computed by engine.backend = \"gpu\"");
}

std::string bytes_of(const std::filesystem::path& file) {
  if (!io::file_fault(file).empty()) return {};  // the packing's reader says what is wrong
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// The bytes of a packing from outside. The fingerprint includes them, because the files may change under their names.
std::string packing_content(const std::filesystem::path& file) {
  if (file.extension() == ".h5") return bytes_of(file);
  std::string name = file.filename().string();
  const std::size_t at = std::min(name.rfind("_particles.csv"), name.rfind("_meta.json"));
  name = at == std::string::npos ? name : name.substr(0, at);
  std::string content;
  for (const char* end : {"_particles.csv", "_meta.json"}) {
    content += bytes_of(file.parent_path() / (name + end));
  }
  return content;
}

/// The title of a case without the key `title`: its folder's name for a case.toml, the file's stem for other names.
std::string default_title(const std::filesystem::path& file) {
  const std::string stem = file.stem().string();
  const std::string folder = std::filesystem::absolute(file).parent_path().filename().string();
  return stem == "case" && !folder.empty() ? folder : stem;
}

/// Reads the title, which names the folder of the results.
std::string read_title(const io::Table& root, const std::filesystem::path& file) {
  // Of 255 bytes that the name of a file may have, 200 are for the title and the rest for endings.
  return root.text(
      {"title", "Title of the run, which also names the folder of its results below `out`."}, default_title(file),
      {.pattern = "[^./][^/]{0,199}",
       .fault = "names the folder of the results: it must not be empty, there must be no / in it and no dot "
                "at its beginning, and it must have at most 200 bytes",
       .default_words = "the name of the case's folder, or of a file with another name than case.toml"});
}

/// Reads all tables of the kind of the case, whose keys are then known to the file.
Case read_case(const io::CaseFile& text, const std::filesystem::path& file) {
  const io::Table root = text.root();
  Case input;
  input.kind = read_kind(root);
  input.name = read_title(root, file);
  read_grain_tables(root, input);
  if (runs_on_a_mesh(input.kind)) read_mesh_tables(root, input);
  if (input.engine.backend == Backend::gpu) check_gpu(root, input);
  if (input.kind == CaseKind::column || input.kind == CaseKind::tunnel) read_ground_tables(root, input);
  if (input.kind == CaseKind::scene) read_scene_tables(root, input);
  check_packing_origin(root, input);
  declare_idle_keys(root, input);
  text.finish();
  return input;
}

/// Cases of this kind in which every key has been read: one, or for a scene several, because some of its keys exclude
/// one another. `more` is added to their text.
std::vector<io::CaseFile> known_cases_of(CaseKind kind, const std::string& more) {
  std::string text = "kind = \"" + to_string(kind) + "\"\n";
  // One entry of each array of tables, and what cannot be left out: the values do not matter.
  text += "[[soil.class]]\nsize_to = \"1 m\"\n" + more;
  if (kind == CaseKind::probe) text += "[[probe.path]]\ngradient = [0, 0, 0, 0]\n";
  if (kind == CaseKind::calibrate) text += "[calibrate]\nrolling_stiffness = [0.1, 0.2]\n";
  const std::vector<std::string> samples = kind == CaseKind::scene ? scene_samples() : std::vector<std::string>{""};
  std::vector<io::CaseFile> files;
  for (const std::string& sample : samples) {
    files.push_back(io::CaseFile::of_text(text + sample, "keys of " + to_string(kind)));
    static_cast<void>(read_case(files.back(), "case.toml"));
  }
  return files;
}

/// The kind of the case; all kinds where it has none or a wrong one, of which the reader has told.
std::vector<CaseKind> possible_kinds(const io::Table& root) {
  try {
    return {read_kind(root)};
  } catch (const io::InputError&) {
    std::vector<CaseKind> kinds;
    for (const auto& [kind, name] : case_kind_names) kinds.push_back(kind);
    return kinds;
  }
}

/// Cases of these kinds in which every key has been read; none where a default does not hold on this machine, such as
/// the folder of packings.
std::vector<io::CaseFile> known_cases(const std::vector<CaseKind>& kinds) {
  try {
    std::vector<io::CaseFile> known;
    for (const CaseKind kind : kinds) {
      for (io::CaseFile& file : known_cases_of(kind, "")) known.push_back(std::move(file));
    }
    return known;
  } catch (const io::InputError&) {
    return {};
  }
}

/// Throws InputError for a key that the kind of this case does not have; of a case without a kind, or with a wrong one,
/// for a key that no kind has.
void refuse_unknown_keys(const io::CaseFile& text) {
  const std::vector<CaseKind> kinds = possible_kinds(text.root());
  if (kinds == std::vector{CaseKind::scene}) return;  // no single case has all keys of a scene
  std::vector<io::InputError> unknown;
  for (const io::CaseFile& known : known_cases(kinds)) {
    try {
      text.finish_as(known);
      return;
    } catch (const io::InputError& found) {
      unknown.push_back(found);
    }
  }
  if (!unknown.empty()) throw io::InputError(unknown.back());
}

/// Reads the case. Where a value is missing or wrong and a key is unknown, the unknown key is reported: it is often a
/// misspelt one, and then the reason why the value is missing.
Case checked_case(const io::CaseFile& text, const std::filesystem::path& file) {
  try {
    return read_case(text, file);
  } catch (const io::InputError&) {
    refuse_unknown_keys(text);
    throw;
  }
}

Case whole_case(const io::CaseFile& text, const std::filesystem::path& file) {
  Case input = checked_case(text, file);
  for (std::string& line : text.idle_keys()) input.remarks.push_back(std::move(line));
  input.resolved = text.resolved();
  input.places = text.places();
  if (input.kind == CaseKind::scene && input.scene.mesh.shape != MeshShape::file)
    check_scene_names(input, names_of_shape(input.scene.mesh));
  input.fingerprint = text.fingerprint(keys_without_results);
  const auto add = [&](const std::string& content) {
    input.fingerprint = io::fingerprint_of(input.fingerprint + content);
  };
  for (const std::filesystem::path& packing : input.packing.files) add(packing_content(packing));
  for (const RegionCase& region : input.scene.regions) {
    for (const std::filesystem::path& packing : region.packing.files) add(packing_content(packing));
  }
  if (!input.scene.mesh.file.empty()) add(bytes_of(input.scene.mesh.file));
  return input;
}

}  // namespace

Case load_case(const std::filesystem::path& file, const std::vector<std::string>& overrides) {
  return whole_case(io::CaseFile::load(file, overrides), file);
}

Case case_of_text(const std::string& text, const std::string& name) {
  return whole_case(io::CaseFile::of_text(text, name), name);
}

io::KeyList keys_of(CaseKind kind, const std::string& more) {
  std::vector<io::KeyList> lists;
  for (const io::CaseFile& file : known_cases_of(kind, more)) lists.push_back({file.keys(), file.tables()});
  return lists.size() == 1 ? lists.front() : join_scene_keys(lists);
}

}  // namespace voussoir::host
