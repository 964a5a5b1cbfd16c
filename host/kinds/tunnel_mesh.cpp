#include "host/kinds/tunnel_mesh.hpp"

#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "fem/mesh_tunnel.hpp"
#include "host/process/build_info.hpp"
#include "io/input_error.hpp"

namespace voussoir::host {
namespace {

constexpr const char* shape_name = "half_tunnel";

/// The keys of [ground] that decide the mesh; the file has a number for each of them.
struct MeshKey {
  const char* name;
  double GroundCase::* member;
  const char* unit;
};
constexpr auto mesh_keys = std::to_array<MeshKey>({
    {"width", &GroundCase::width, " m"},
    {"height", &GroundCase::height, " m"},
    {"diameter", &GroundCase::diameter, " m"},
    {"cover_ratio", &GroundCase::cover_ratio, ""},
    {"mesh_size_opening", &GroundCase::mesh_size_opening, " m"},
    {"mesh_size_far", &GroundCase::mesh_size_far, " m"},
});

fem::HalfTunnelOptions options_of(const GroundCase& soil) {
  return {.width = soil.width,
          .height = soil.height,
          .diameter = soil.diameter,
          .cover = soil.cover(),
          .size_near = soil.mesh_size_opening,
          .size_far = soil.mesh_size_far};
}

/// What `make` returns; what it throws is a fault of [ground], since a generated mesh depends on nothing else.
template <class Make>
auto of_ground(Make&& make) {
  const auto refuse = [](const std::exception& error) {
    return io::InputError("[ground]", "", fmt::format("makes no mesh: {}", error.what()));
  };
  try {
    return make();
  } catch (const std::invalid_argument& error) {
    throw refuse(error);
  } catch (const std::runtime_error& error) {
    throw refuse(error);
  }
}

/// The ground of a file's numbers. Throws where they are not those of the case; they are compared to the 12 digits that
/// decide a fingerprint, since the same length may be written in another unit.
GroundCase confirmed_ground(const io::StoredMesh& stored, const GroundCase& soil) {
  const auto shape = stored.labels.find("shape");
  if (shape == stored.labels.end() || shape->second != shape_name)
    throw std::runtime_error(fmt::format("is no mesh of the shape {}", shape_name));
  GroundCase made_for = soil;
  for (const MeshKey& key : mesh_keys) {
    const auto number = stored.numbers.find(key.name);
    if (number == stored.numbers.end()) throw std::runtime_error(fmt::format("does not say its {}", key.name));
    const double wanted = soil.*key.member;
    if (std::abs(number->second - wanted) > 1e-12 * std::abs(wanted))
      throw std::runtime_error(fmt::format("was made for ground.{0} = {1:.12g}{3}, but the case has {2:.12g}{3}",
                                           key.name, number->second, wanted, key.unit));
    made_for.*key.member = number->second;
  }
  return made_for;
}

fem::QuadMesh quads_of(const io::StoredMesh& stored) {
  fem::QuadMesh mesh;
  mesh.corners = Eigen::Map<const fem::Coordinates>(stored.corners.data(), 2,
                                                    static_cast<Eigen::Index>(stored.nodes()));
  mesh.quads.resize(stored.elements());
  for (std::size_t k = 0; k < stored.quads.size(); ++k) mesh.quads[k / 4][k % 4] = static_cast<int>(stored.quads[k]);
  return mesh;
}

fem::Mesh stored_tunnel_mesh(const GroundCase& soil) {
  const io::StoredMesh stored = io::load_mesh(soil.mesh_file);
  try {
    return fem::complete_half_tunnel(options_of(confirmed_ground(stored, soil)), quads_of(stored));
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(fmt::format("{}: {}", soil.mesh_file.string(), fault.what()));
  }
}

}  // namespace

fem::Mesh tunnel_mesh(const GroundCase& soil) {
  if (!soil.mesh_file.empty()) return stored_tunnel_mesh(soil);
  return of_ground([&] { return fem::make_half_tunnel(options_of(soil)); });
}

io::StoredMesh mesh_to_store(const GroundCase& soil) {
  const fem::QuadMesh mesh = of_ground([&] { return fem::half_tunnel_quads(options_of(soil)); });
  io::StoredMesh stored;
  stored.corners.assign(mesh.corners.data(), mesh.corners.data() + mesh.corners.size());
  for (const fem::Quad& quad : mesh.quads) stored.quads.insert(stored.quads.end(), quad.begin(), quad.end());
  for (const MeshKey& key : mesh_keys) stored.numbers[key.name] = soil.*key.member;
  stored.labels = {{"shape", shape_name}, {"made_by", fmt::format("voussoir {} ({})", build_version, build_revision)}};
  return stored;
}

}  // namespace voussoir::host
