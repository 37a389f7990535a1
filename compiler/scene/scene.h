// A scene as a compiler sees it: what materials ask for, what lights there are, and enough geometry
// to weigh materials by their area and to look at the result.
//
// gltf.h makes one of glTF 2.0. Units are glTF's: meters, radians, candela (point, spot), lux
// (directional); colors are linear. Values are as the file has them, defaults filled in; what they
// mean for a model is analyze/residual/facts.h's business.
#pragma once

#include "scene/components.h"

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace lobe::scene {

using Vector3 = std::array<float, 3>;
using Color = std::array<double, 3>;
/// Column-major, as glTF has it.
using Matrix = std::array<double, 16>;

/// Where something stands in the file, as a JSON pointer: `/materials/3/pbrMetallicRoughness`.
using Pointer = std::string;

/// A decoded picture, row by row from the top, 4 channels in [0, 1], as stored: no transfer
/// function undone.
struct Pixels {
    int width = 0;
    int height = 0;
    std::vector<float> rgba;
};

/// What one channel of a picture holds. `levels` tells a mask from a gradient.
struct ChannelFacts {
    float low = 0;
    float high = 1;
    bool only_ends = false;  ///< every texel is 0 or 1
};

struct Image {
    std::string name;
    Pointer pointer;
    std::optional<Pixels> pixels;  ///< none: not readable, see `why`
    std::string why;               ///< it was not read; the channels are then full
    int width = 0;                 ///< 0: not read
    int height = 0;
    std::array<ChannelFacts, 4> channels;  ///< of the values as stored
    std::array<ChannelFacts, 3> linear;    ///< of the sRGB-decoded values of r, g, b
};

/// A use of a picture: `KHR_texture_transform` included.
struct Texture {
    std::size_t image = 0;  ///< index into Scene::images
    int coordinates = 0;    ///< TEXCOORD_n
    std::array<double, 2> offset{0, 0};
    std::array<double, 2> scale{1, 1};
    double rotation = 0;
    bool repeats_u = true;  ///< else clamped; mirrored repeats count as repeats
    bool repeats_v = true;
    /// Values between those of texels occur: the sampler does not say NEAREST for both filters.
    bool is_filtered = true;
    Pointer pointer;
};

/// A number, or a few, that a material gives: factor, times a texture's channels where there is
/// one, plus `offset`. Where the file gives a range (`{"min": …, "max": …}` in `extras.lobe`: game
/// code sets the value), low and high differ.
struct Value {
    Components low;   ///< one per component; of the factor
    Components high;  ///< the same as `low` for a constant
    Components offset;
    std::optional<Texture> texture;
    std::vector<int> channels;  ///< of the texture, one per component: 0 r … 3 a
    bool is_srgb = false;       ///< the texture's r, g and b are to be decoded before use; a is not
    Pointer pointer;
    bool is_given = false;  ///< false: the format's default
};

/// A material over another one.
struct Layer {
    std::size_t material = 0;
    Value weight{};  ///< one component in [0, 1]
};

struct Material {
    std::string name;
    Pointer pointer;
    Value base_color{};  ///< 4 components; the fourth is alpha
    Value metallic{};
    Value roughness{};
    Value emissive{};  ///< with KHR_materials_emissive_strength multiplied in
    std::optional<Texture> normal_map;
    double normal_scale = 1;
    std::optional<Texture> occlusion_map;
    bool double_sided = false;
    bool is_unlit = false;
    enum class Alpha : std::uint8_t {
        opaque,
        mask,
        blend
    };
    Alpha alpha = Alpha::opaque;
    double alpha_cutoff = 0.5;
    /// What the ratified KHR_materials_* give, under the extension's own property names in
    /// snake case with the extension's name before those that need it: `ior`, `specular`,
    /// `specular_color`, `clearcoat`, `clearcoat_roughness`, `sheen_color`, `sheen_roughness`,
    /// `transmission`, `thickness`, `attenuation_distance`, `attenuation_color`, `iridescence`,
    /// `iridescence_ior`, `iridescence_thickness_minimum`, `iridescence_thickness_maximum`,
    /// `anisotropy`, `anisotropy_rotation`, `dispersion`. Only what the file names.
    std::map<std::string, Value> extensions;
    /// `extras.lobe.parameters`: a model's own parameters by their names in the model.
    std::map<std::string, Value> parameters;
    /// `extras.lobe.layers`: materials blended over this one, the lowest first.
    std::vector<Layer> layers;
};

struct Light {
    enum class Kind : std::uint8_t {
        directional,
        point,
        spot,
        sphere,  ///< a point with `extras.lobe.radius`
        tube     ///< a point with `extras.lobe.radius` and `extras.lobe.length`, along its local x
    };
    std::string name;
    Pointer pointer;
    Kind kind = Kind::point;
    Color color{1, 1, 1};
    double intensity = 1;
    std::optional<double> range;  ///< none: unlimited
    double inner_cone = 0;
    double outer_cone = 0.7853981633974483;
    double radius = 0;
    double length = 0;
    Matrix world{};  ///< a light shines along its local -z
};

/// EXT_lights_image_based.
struct Environment {
    std::string name;
    Pointer pointer;
    double intensity = 1;
    std::array<double, 4> rotation{0, 0, 0, 1};  ///< a quaternion, x y z w
    /// Irradiance at the unit normal n is the sum of these times the real spherical harmonics Y(n)
    /// of the cube's axes, in the order (0,0) (1,-1) (1,0) (1,1) (2,-2) … (2,2): y is (1,-1), z
    /// (1,0), x (1,1).
    std::array<Color, 9> irradiance{};
    /// Prefiltered cube maps: mips from the sharpest, six faces each (+x -x +y -y +z -z, as seen
    /// from the middle: the cube's z is the world's -z), indices into Scene::images. The pictures
    /// are RGBD: radiance is sRGB-decoded rgb over alpha. docs/scenes.md has the sources.
    std::vector<std::array<std::size_t, 6>> specular;
    int specular_size = 0;  ///< texels along an edge of the sharpest mip
};

/// A primitive, its accessors decoded. All present attributes have as many elements. Skins and
/// morph targets are left out: this is the pose of the file.
struct Mesh {
    std::string name;
    Pointer pointer;
    std::vector<Vector3> positions;
    std::vector<Vector3> normals;                ///< empty: flat
    std::vector<std::array<float, 4>> tangents;  ///< empty: none
    std::array<std::vector<std::array<float, 2>>, 2> coordinates;
    std::vector<std::array<float, 4>>
        colors;                            ///< COLOR_0, linear; empty: none. Base color times it
    std::vector<std::uint32_t> triangles;  ///< three per triangle; empty for points and lines
    /// What the attributes hold, known without them too (ReadOptions::geometry).
    bool has_tangents = false;
    Vector3 least_color{1, 1, 1};  ///< of COLOR_0's vertices; 1 where there is none
    Vector3 greatest_color{1, 1, 1};
    std::size_t material = 0;  ///< index into Scene::materials
};

struct Instance {
    std::size_t mesh = 0;
    Matrix world{};
    double area = 0;  ///< of its triangles in the world, in square meters
};

struct Camera {
    std::string name;
    Matrix world{};  ///< looks along its local -z
    double vertical_field_of_view = 0.7;
    double aspect_ratio = 0;            ///< 0: the picture's
    std::optional<double> half_height;  ///< of an orthographic camera
};

struct Scene {
    std::string path;
    std::vector<Image> images;
    /// The file's, then the format's default where a primitive names none or the file has none.
    std::vector<Material> materials;
    std::vector<Mesh> meshes;         ///< one per primitive
    std::vector<Instance> instances;  ///< of the default scene, or of the first
    std::vector<Light> lights;        ///< that nodes of the scene carry
    std::optional<Environment> environment;
    std::vector<Camera> cameras;

    /// World-space area of the triangles that show each material, by index. A scene without
    /// geometry, or of no area, gives every material the same.
    std::vector<double> coverage() const;
    /// Indices of materials that something shows, or all where nothing is shown; with the materials
    /// of their layers.
    std::vector<std::size_t> shown_materials() const;
};

}  // namespace lobe::scene
