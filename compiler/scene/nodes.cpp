// Nodes: the tree of what stands where. Nothing here recurses: a file may nest a million nodes.
#include "scene/nodes.h"

#include "scene/matrix.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace lobe::scene {
namespace {

Camera read_camera(const View& view)
{
    Camera camera;
    if (!view.expect_object() || !view.require("type")) return camera;
    camera.name = view.text("name");
    const auto type = view.choice("type", {"perspective", "orthographic"});
    if (!type) return camera;
    if (*type == 0) {
        const auto lens = view.object("perspective");
        if (!lens) {
            view.require("perspective");
            return camera;
        }
        if (!lens->require("yfov") || !lens->require("znear")) return camera;
        camera.vertical_field_of_view =
            lens->number("yfov", 0.7, {0, std::numbers::pi, true, true});
        camera.aspect_ratio = lens->number("aspectRatio", 0, positive);
        lens->number(
            "zfar", 0,
            {lens->number("znear", 0, positive), std::numeric_limits<double>::infinity(), true});
    } else {
        const auto box = view.object("orthographic");
        if (!box) {
            view.require("orthographic");
            return camera;
        }
        for (const char* name : {"xmag", "ymag", "znear", "zfar"})
            if (!box->require(name)) return camera;
        const double half_width = box->number("xmag", 1, positive);
        camera.half_height = box->number("ymag", 1, positive);
        camera.aspect_ratio = half_width / *camera.half_height;
        box->number(
            "zfar", 1,
            {box->number("znear", 0, not_negative), std::numeric_limits<double>::infinity(), true});
    }
    return camera;
}

struct Node {
    Matrix local = identity;
    std::vector<std::size_t> children;
    std::optional<std::size_t> mesh;
    std::optional<std::size_t> camera;
    std::optional<std::size_t> light;
    bool has_parent = false;
    bool is_reached = false;
};

Matrix read_transform(const View& view)
{
    const bool is_split =
        view.member("translation") || view.member("rotation") || view.member("scale");
    if (const auto matrix = view.member("matrix")) {
        if (is_split) matrix->error("`matrix` stands beside `translation`, `rotation` or `scale`");
        Matrix result = identity;
        matrix->fill(result);
        return result;
    }
    if (!is_split) return identity;
    const auto translation = view.numbers("translation", {0, 0, 0});
    const auto scale = view.numbers("scale", {1, 1, 1});
    return compose({translation[0], translation[1], translation[2]}, view.rotation("rotation"),
                   {scale[0], scale[1], scale[2]});
}

class Tree {
public:
    Tree(const View& root, const Carried& carried, const Limits& limits, Scene& scene)
        : carried_{carried}, limits_{limits}, complaints_{root.complaints()}, scene_{scene}
    {
        if (const auto listed = root.array("cameras"))
            for (std::size_t index = 0; index < listed->size(); ++index)
                cameras_.push_back(read_camera((*listed)[index]));
    }

    void read_nodes(const View& root)
    {
        const auto listed = root.array("nodes");
        if (!listed) return;
        if (listed->size() > limits_.nodes) {
            listed->error(
                fmt::format("{} nodes are above the limit of {}", listed->size(), limits_.nodes));
            is_above_limit_ = true;
            return;
        }
        nodes_.resize(listed->size());
        for (std::size_t index = 0; index < nodes_.size(); ++index)
            read_node((*listed)[index], nodes_[index]);
        refuse_rings();
    }

    void read_scenes(const View& root)
    {
        if (is_above_limit_) return;
        const auto listed = root.array("scenes");
        const std::size_t count = listed ? listed->size() : 0;
        const std::size_t shown = root.index("scene", count, "scenes").value_or(0);
        for (std::size_t index = 0; index < count; ++index) {
            const View view = (*listed)[index];
            if (!view.expect_object()) continue;
            const auto roots = scene_roots(view);
            const auto environment = environment_of(view);
            if (index != shown) continue;
            place(roots);
            if (environment) scene_.environment = carried_.environments[*environment];
        }
    }

private:
    void read_node(const View& view, Node& node)
    {
        if (!view.expect_object()) return;
        node.local = read_transform(view);
        node.mesh = view.index("mesh", carried_.meshes.size(), "meshes");
        node.camera = view.index("camera", cameras_.size(), "cameras");
        if (const auto punctual = view.extension("KHR_lights_punctual"))
            if (punctual->require("light"))
                node.light = punctual->index("light", carried_.lights.size(), "lights");
        const auto children = view.array("children");
        for (std::size_t at = 0; children && at < children->size(); ++at) {
            const View given = (*children)[at];
            const auto child = given.index(nodes_.size(), "nodes");
            if (!child) continue;
            if (nodes_[*child].has_parent) {
                given.error(fmt::format("node {} is a child already", *child));
                continue;
            }
            nodes_[*child].has_parent = true;
            node.children.push_back(*child);
        }
    }

    /// A node has one parent at most, so what no root reaches is in a ring, or hangs on one.
    void refuse_rings()
    {
        std::vector<std::size_t> open;
        for (std::size_t index = 0; index < nodes_.size(); ++index)
            if (!nodes_[index].has_parent) open.push_back(index);
        while (!open.empty()) {
            Node& node = nodes_[open.back()];
            open.pop_back();
            node.is_reached = true;
            open.insert(open.end(), node.children.begin(), node.children.end());
        }
        const auto lost =
            std::ranges::find_if(nodes_, [](const Node& node) { return !node.is_reached; });
        if (lost != nodes_.end())
            complaints_.error(Pointer{"/nodes"} / static_cast<std::size_t>(lost - nodes_.begin()),
                              "this node is its own ancestor, or below one that is");
    }

    std::vector<std::size_t> scene_roots(const View& view) const
    {
        std::vector<std::size_t> roots;
        const auto listed = view.array("nodes");
        for (std::size_t at = 0; listed && at < listed->size(); ++at) {
            const auto node = (*listed)[at].index(nodes_.size(), "nodes");
            if (!node) continue;
            if (nodes_[*node].has_parent)
                (*listed)[at].error(fmt::format("node {} is a child, and no root", *node));
            else
                roots.push_back(*node);
        }
        std::vector<std::size_t> sorted = roots;
        std::ranges::sort(sorted);
        const auto twice = std::ranges::adjacent_find(sorted);
        if (twice == sorted.end()) return roots;
        listed->error(fmt::format("node {} is listed twice", *twice));
        return {};
    }

    std::optional<std::size_t> environment_of(const View& view) const
    {
        const auto extension = view.extension("EXT_lights_image_based");
        if (!extension || !extension->require("light")) return std::nullopt;
        return extension->index("light", carried_.environments.size(), "lights");
    }

    void place(const std::vector<std::size_t>& roots)
    {
        struct Open {
            std::size_t node;
            Matrix parent;
        };
        std::vector<Open> open;
        const auto push = [&](const std::vector<std::size_t>& nodes, const Matrix& parent) {
            for (std::size_t at = nodes.size(); at > 0; --at)  // the first is placed first
                open.push_back({nodes[at - 1], parent});
        };
        push(roots, identity);
        while (!open.empty()) {
            const Open next = open.back();
            open.pop_back();
            const Node& node = nodes_[next.node];
            const Matrix world = multiply(next.parent, node.local);
            if (!is_placeable(world)) {
                complaints_.error(Pointer{"/nodes"} / next.node,
                                  fmt::format("in the world this node is beyond {:.0e}", farthest));
                continue;
            }
            carry(next.node, world);
            push(node.children, world);
        }
    }

    /// Products of three of these and a float are finite in 64 bits.
    static constexpr double farthest = 1e30;
    static bool is_placeable(const Matrix& world)
    {
        return std::ranges::all_of(world,
                                   [](double element) { return std::abs(element) <= farthest; });
    }

    void carry(std::size_t index, const Matrix& world)
    {
        const Node& node = nodes_[index];
        if (node.camera) {
            scene_.cameras.push_back(cameras_[*node.camera]);
            scene_.cameras.back().world = world;
        }
        if (node.light) {
            scene_.lights.push_back(carried_.lights[*node.light]);
            scene_.lights.back().world = world;
        }
        if (!node.mesh) return;
        const std::size_t begin = carried_.meshes.first[*node.mesh];
        const std::size_t end = carried_.meshes.first[*node.mesh + 1];
        if (end - begin > limits_.instances - scene_.instances.size()) {
            if (!is_full_)
                complaints_.error(Pointer{"/nodes"} / index / "mesh",
                                  fmt::format("with this mesh more than {} primitives are shown",
                                              limits_.instances));
            is_full_ = true;
            return;
        }
        for (std::size_t mesh = begin; mesh < end; ++mesh)
            scene_.instances.push_back({mesh, world, 0});
    }

    const Carried& carried_;
    const Limits& limits_;
    Complaints& complaints_;
    Scene& scene_;
    std::vector<Camera> cameras_;
    std::vector<Node> nodes_;
    bool is_above_limit_ = false;
    bool is_full_ = false;
};

}  // namespace

void place_nodes(const View& root, const Carried& carried, const Limits& limits, Scene& scene)
{
    Tree tree{root, carried, limits, scene};
    tree.read_nodes(root);
    tree.read_scenes(root);
}

}  // namespace lobe::scene
