// SPDX-License-Identifier: GPL-3.0-or-later
#include "tests/fuzz/targets.hpp"

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <iterator>

#include "experiments/evolve/config.hpp"
#include "solver/error.hpp"
#include "solver/mesh/mesh_file.hpp"
#include "solver/read_json.hpp"
#include "solver/tables/claims.hpp"
#include "solver/tables/table.hpp"
#include "solver/time/checkpoint.hpp"

namespace esfem {
namespace {

using nlohmann::json;

template <MeshFile (*parse)(const std::string& file, const std::string& content)>
void read_mesh_file(const std::string& content) {
  MeshFile file = parse("input", content);
  repair_and_check(file);
}

void read_table(const std::string& content) {
  const Table table = table_from_json(parse_json(content, "input"), "input");
  to_csv(table);
  to_latex(table);
  to_json(table).dump();
}

void read_claims(const std::string& content) {
  reference_from_json(parse_json(content, "input"), "input");
}

/// Everything but the time that a fine mesh takes: "mesh" is a small file.
void read_configuration(const std::string& content) {
  json description = parse_json(content, "input");
  if (description.is_object() && description.contains("mesh") && description["mesh"].is_object()) {
    json& mesh = description["mesh"];
    for (const char* key : {"edge_length", "subdivisions", "remesh"}) mesh.erase(key);
    mesh["file"] = ESFEM_SOURCE_DIR "/tests/fuzz/corpus/off/octahedron.off";
  }
  evolve_config(description, "input");
}

struct Position {
  double t = 0;
  Field x;
  static constexpr NamedField<Position> fields[] = {{"x", &Position::x}};
};

/// Whether a run of two nodes resumes from its checkpoint.
bool goes_on(const std::string& file) {
  History<Position> past(2);
  RunPosition done;
  Position initial;
  initial.x = Field::Zero(2, 3);
  Checkpoint checkpoint(file, {{"run", "fuzz"}}, 0);
  const auto no_objection = [](const RunPosition&) { return std::string(); };
  if (checkpoint.resume({{"tau", 0.5}}, initial, past, done, no_objection)) return true;
  past.push(initial);
  checkpoint.save(done, past);
  return false;
}

/// The content is what the states of a checkpoint of this run are, in CBOR: the checksum would hide
/// everything else.
void read_checkpoint(const std::string& content) {
  static const std::string file =
      (std::filesystem::temp_directory_path() / format("esfem_fuzz_%d.checkpoint", int(getpid()))).string();
  static const json whole = [] {
    std::filesystem::remove(file);
    goes_on(file);
    std::ifstream stream(file, std::ios::binary);
    return unseal({std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()});
  }();
  unseal(content);
  json changed = whole;
  changed["run"] = unseal(checksum(content) + content);
  if (changed["run"].is_discarded()) throw InputError("no CBOR");
  std::ofstream(file, std::ios::binary) << seal(changed);
  goes_on(file);
}

}  // namespace

const std::map<std::string, std::function<void(const std::string&)>>& fuzz_targets() {
  static const std::map<std::string, std::function<void(const std::string&)>> targets = {
      {"checkpoint", read_checkpoint},
      {"claims", read_claims},
      {"configuration", read_configuration},
      {"msh", read_mesh_file<parse_msh>},
      {"obj", read_mesh_file<parse_obj>},
      {"off", read_mesh_file<parse_off>},
      {"ply", read_mesh_file<parse_ply>},
      {"stl", read_mesh_file<parse_stl>},
      {"table", read_table},
      {"vtu", read_mesh_file<parse_vtu>}};
  return targets;
}

}  // namespace esfem
