// Meshes: primitives with their accessors decoded, as lists of triangles.
#include "scene/meshes.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string>
#include <utility>

namespace lobe::scene {
namespace {

/// OpenGL's numbers for what indices make; below these they make points and lines.
constexpr std::size_t mode_triangles = 4;
constexpr std::size_t mode_strip = 5;
constexpr std::size_t mode_fan = 6;

/// Which component types an attribute takes.
enum class Kind {
    position,
    direction,  ///< NORMAL and TANGENT
    coordinates,
    color
};

/// [glTF2] "Meshes", and KHR_mesh_quantization where it is required.
bool takes(Kind kind, const Accessor& accessor, bool quantized)
{
    const bool is_signed =
        accessor.type == ComponentType::int8 || accessor.type == ComponentType::int16;
    switch (accessor.type) {
    case ComponentType::float32: return true;
    case ComponentType::uint32: return false;
    case ComponentType::int8:
    case ComponentType::int16:
    case ComponentType::uint8:
    case ComponentType::uint16: break;
    }
    switch (kind) {
    case Kind::position: return quantized;
    case Kind::direction: return quantized && is_signed && accessor.is_normalized;
    case Kind::coordinates: return quantized || (!is_signed && accessor.is_normalized);
    case Kind::color: return !is_signed && accessor.is_normalized;
    }
    return false;
}

/// Triangle `index` of a list of `count` vertices; false where the list ends before it.
bool corners_of(std::size_t mode, std::size_t count, std::size_t index,
                std::array<std::size_t, 3>& corners)
{
    if (mode == mode_triangles) {
        corners = {3 * index, 3 * index + 1, 3 * index + 2};
        return corners[2] < count;
    }
    const std::size_t odd = index % 2;
    if (mode == mode_strip)
        corners = {index, index + 1 + odd, index + 2 - odd};
    else
        corners = {index + 1, index + 2, 0};
    return index + 2 < count;
}

class Reading {
public:
    Reading(const Accessors& accessors, std::size_t material_count, bool quantized,
            const ReadOptions& options)
        : accessors_{accessors}, material_count_{material_count},
          quantized_{quantized}, options_{options}
    {
    }

    Mesh primitive(const View& view)
    {
        Mesh mesh;
        mesh.pointer = view.pointer();
        mesh.material = material_count_;
        if (!view.expect_object() || !view.require("attributes")) return mesh;
        if (view.member("material"))
            mesh.material =
                view.index("material", material_count_, "materials").value_or(material_count_);
        const std::size_t mode = view.whole("mode", mode_triangles, 0, mode_fan);
        const auto attributes = view.object("attributes");
        if (!attributes || !list_attributes(view, *attributes)) return mesh;
        read_attributes(*attributes, mesh);
        if (mode >= mode_triangles) read_triangles(view, mode, mesh);
        return mesh;
    }

private:
    /// Fills `attributes_`. True if there are vertices, and not too many.
    bool list_attributes(const View& view, const View& attributes)
    {
        attributes_.clear();
        vertex_count_ = 0;
        for (const std::string_view name : attributes.names()) {
            const auto index = attributes.index(name, accessors_.size(), "accessors");
            if (!index || !accessors_[*index]) continue;
            const Accessor& accessor = *accessors_[*index];
            if (vertex_count_ == 0) vertex_count_ = accessor.count;
            if (accessor.count != vertex_count_) {
                attributes.member(name)->error(fmt::format(
                    "{} elements, where another attribute has {}", accessor.count, vertex_count_));
                return false;
            }
            attributes_.emplace(name, &accessor);
        }
        if (!attributes_.contains("POSITION")) return false;
        if (vertex_count_ > options_.limits.vertices - vertices_) {
            view.error(
                fmt::format("with this primitive's {} vertices all are above the limit of {}",
                            vertex_count_, options_.limits.vertices));
            return false;
        }
        vertices_ += vertex_count_;
        return true;
    }

    std::optional<std::vector<float>> floats(const View& attributes, const std::string& name,
                                             Kind kind, std::size_t rows) const
    {
        const auto found = attributes_.find(name);
        if (found == attributes_.end()) return std::nullopt;
        const Accessor& accessor = *found->second;
        const bool is_rgb = kind == Kind::color && accessor.rows == 3;
        const bool has_rows = accessor.columns == 1 && (accessor.rows == rows || is_rgb);
        if (has_rows && takes(kind, accessor, quantized_))
            return read_floats(accessor, attributes.complaints());
        attributes.member(name)->error(
            fmt::format("{} takes no accessor of this type", name),
            has_rows && takes(kind, accessor, true)
                ? "integers need `KHR_mesh_quantization` in `extensionsRequired`"
                : "");
        return std::nullopt;
    }

    template <std::size_t Width>
    std::vector<std::array<float, Width>> vectors(const View& attributes, const std::string& name,
                                                  Kind kind) const
    {
        std::vector<std::array<float, Width>> result;
        const auto values = floats(attributes, name, kind, Width);
        if (!values) return result;
        const std::size_t width = values->size() / vertex_count_;
        result.resize(vertex_count_);
        for (std::size_t vertex = 0; vertex < vertex_count_; ++vertex)
            for (std::size_t row = 0; row < Width; ++row)
                result[vertex][row] = row < width ? (*values)[vertex * width + row] : 1;
        return result;
    }

    void read_attributes(const View& attributes, Mesh& mesh) const
    {
        mesh.positions = vectors<3>(attributes, "POSITION", Kind::position);
        mesh.has_tangents = attributes_.contains("TANGENT");
        mesh.colors = vectors<4>(attributes, "COLOR_0", Kind::color);
        for (std::size_t row = 0; row < 3 && !mesh.colors.empty(); ++row) {
            const auto [least, greatest] = std::ranges::minmax(
                mesh.colors, {}, [row](const std::array<float, 4>& color) { return color[row]; });
            mesh.least_color[row] = least[row];
            mesh.greatest_color[row] = greatest[row];
        }
        if (!options_.geometry) {
            mesh.colors.clear();
            return;
        }
        mesh.normals = vectors<3>(attributes, "NORMAL", Kind::direction);
        mesh.tangents = vectors<4>(attributes, "TANGENT", Kind::direction);
        mesh.coordinates[0] = vectors<2>(attributes, "TEXCOORD_0", Kind::coordinates);
        mesh.coordinates[1] = vectors<2>(attributes, "TEXCOORD_1", Kind::coordinates);
    }

    /// What triangles index, all below the number of vertices. Nothing after a complaint.
    std::optional<std::vector<std::uint32_t>> indices(const View& view) const
    {
        const auto given = view.member("indices");
        const auto index = view.index("indices", accessors_.size(), "accessors");
        if (!index || !accessors_[*index]) return std::nullopt;
        const Accessor& accessor = *accessors_[*index];
        const bool is_unsigned = accessor.type == ComponentType::uint8 ||
                                 accessor.type == ComponentType::uint16 ||
                                 accessor.type == ComponentType::uint32;
        if (accessor.rows != 1 || accessor.is_normalized || !is_unsigned) {
            given->error(fmt::format("accessor {} has no unsigned integers", *index));
            return std::nullopt;
        }
        if (accessor.count / 3 > options_.limits.triangles - triangles_) {
            complain_of_triangles(view);
            return std::nullopt;
        }
        auto indices = read_integers(accessor);
        for (std::size_t at = 0; at < indices.size(); ++at)
            if (indices[at] >= vertex_count_) {
                given->error(fmt::format("index {} at {} is past the {} vertices", indices[at], at,
                                         vertex_count_));
                return std::nullopt;
            }
        return indices;
    }

    void complain_of_triangles(const View& view) const
    {
        view.error(fmt::format("with this primitive's triangles all are above the limit of {}",
                               options_.limits.triangles));
    }

    void read_triangles(const View& view, std::size_t mode, Mesh& mesh)
    {
        std::optional<std::vector<std::uint32_t>> indexed;
        if (view.member("indices")) {
            indexed = indices(view);
            if (!indexed) return;
        }
        const std::size_t count = indexed ? indexed->size() : vertex_count_;
        const std::size_t most = mode == mode_triangles ? count / 3 : count < 3 ? 0 : count - 2;
        if (most > options_.limits.triangles - triangles_) {
            complain_of_triangles(view);
            return;
        }
        mesh.triangles.reserve(3 * most);
        std::array<std::size_t, 3> corners{};
        for (std::size_t index = 0; corners_of(mode, count, index, corners); ++index) {
            std::array<std::uint32_t, 3> triangle{};
            for (std::size_t corner = 0; corner < 3; ++corner)
                triangle[corner] = indexed ? (*indexed)[corners[corner]]
                                           : static_cast<std::uint32_t>(corners[corner]);
            // Strips turn corners by triangles without an area.
            if (triangle[0] == triangle[1] || triangle[1] == triangle[2] ||
                triangle[2] == triangle[0])
                continue;
            mesh.triangles.insert(mesh.triangles.end(), triangle.begin(), triangle.end());
        }
        triangles_ += mesh.triangles.size() / 3;
    }

    const Accessors& accessors_;
    std::size_t material_count_;
    bool quantized_;
    const ReadOptions& options_;
    std::map<std::string, const Accessor*> attributes_;  ///< of the primitive that is read
    std::size_t vertex_count_ = 0;                       ///< of the primitive that is read
    std::size_t vertices_ = 0;                           ///< of all so far
    std::size_t triangles_ = 0;
};

}  // namespace

Meshes read_meshes(const View& root, const Accessors& accessors, std::size_t material_count,
                   bool quantized, const ReadOptions& options)
{
    Meshes meshes;
    const auto listed = root.array("meshes");
    Reading reading{accessors, material_count, quantized, options};
    for (std::size_t index = 0; listed && index < listed->size(); ++index) {
        const View view = (*listed)[index];
        if (view.expect_object() && view.require("primitives")) {
            const std::string name = view.text("name");
            const auto primitives = view.array("primitives");
            for (std::size_t at = 0; primitives && at < primitives->size(); ++at) {
                meshes.primitives.push_back(reading.primitive((*primitives)[at]));
                meshes.primitives.back().name = name;
                meshes.shows_default |= meshes.primitives.back().material == material_count;
            }
        }
        meshes.first.push_back(meshes.primitives.size());
    }
    return meshes;
}

}  // namespace lobe::scene
