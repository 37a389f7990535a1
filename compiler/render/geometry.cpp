#include "render/geometry.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <limits>
#include <vector>

namespace lobe::render {

struct Geometry::Embree {
    const scene::Scene* scene = nullptr;
    RTCDevice device = nullptr;
    RTCScene tree = nullptr;
    /// Per instance: positions in the world. One float more at the end: Embree reads 16 bytes.
    std::vector<std::vector<float>> positions;
    std::vector<std::size_t> instance_of;  ///< per geometry

    ~Embree()
    {
        if (tree != nullptr) rtcReleaseScene(tree);
        if (device != nullptr) rtcReleaseDevice(device);
    }
};

Geometry::Geometry(const scene::Scene& scene) : embree_{std::make_unique<Embree>()}
{
    embree_->scene = &scene;
    embree_->device = rtcNewDevice("threads=1,user_threads=1");
    embree_->tree = rtcNewScene(embree_->device);
    rtcSetSceneFlags(embree_->tree, RTC_SCENE_FLAG_ROBUST);
    embree_->positions.resize(scene.instances.size());
    for (std::size_t i = 0; i < scene.instances.size(); ++i) {
        const scene::Mesh& mesh = scene.meshes[scene.instances[i].mesh];
        if (mesh.triangles.empty()) continue;
        std::vector<float>& world = embree_->positions[i];
        world.reserve(mesh.positions.size() * 3 + 1);
        for (const Vector3& position : mesh.positions)
            for (const float x : moved(scene.instances[i].world, position)) world.push_back(x);
        world.push_back(0);
        RTCGeometry part = rtcNewGeometry(embree_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        rtcSetSharedGeometryBuffer(part, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, world.data(),
                                   0, 3 * sizeof(float), mesh.positions.size());
        rtcSetSharedGeometryBuffer(part, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                   mesh.triangles.data(), 0, 3 * sizeof(std::uint32_t),
                                   mesh.triangles.size() / 3);
        rtcCommitGeometry(part);
        const unsigned id = rtcAttachGeometry(embree_->tree, part);
        rtcReleaseGeometry(part);
        if (embree_->instance_of.size() <= id) embree_->instance_of.resize(id + 1);
        embree_->instance_of[id] = i;
    }
    rtcCommitScene(embree_->tree);
}

Geometry::~Geometry() = default;

namespace {

RTCRay ray_of(const Ray& from, float distance)
{
    RTCRay ray{};
    ray.org_x = from.origin[0];
    ray.org_y = from.origin[1];
    ray.org_z = from.origin[2];
    ray.dir_x = from.direction[0];
    ray.dir_y = from.direction[1];
    ray.dir_z = from.direction[2];
    ray.tfar = distance;
    ray.mask = ~0U;
    return ray;
}

}  // namespace

std::optional<Hit> Geometry::first(const Ray& ray) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = ray_of(ray, std::numeric_limits<float>::infinity());
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(embree_->tree, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
    return Hit{embree_->instance_of[query.hit.geomID], query.hit.primID, query.hit.u, query.hit.v,
               query.ray.tfar};
}

bool Geometry::blocked(const Ray& ray, float distance) const
{
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = ray_of(ray, distance);
    rtcOccluded1(embree_->tree, &context, &query);
    return query.tfar < 0;  // Embree's answer is minus infinity
}

Bounds Geometry::bounds() const
{
    if (embree_->instance_of.empty()) return {};
    RTCBounds box{};
    rtcGetSceneBounds(embree_->tree, &box);
    const Vector3 low{box.lower_x, box.lower_y, box.lower_z};
    const Vector3 high{box.upper_x, box.upper_y, box.upper_z};
    return {(low + high) * 0.5F, length(high - low) / 2};
}

Vector3 Geometry::corner(const Hit& hit, int index) const
{
    const scene::Mesh& mesh = embree_->scene->meshes[embree_->scene->instances[hit.instance].mesh];
    const std::size_t at = 3 * std::size_t{mesh.triangles[3 * hit.triangle + index]};
    const std::vector<float>& world = embree_->positions[hit.instance];
    return {world[at], world[at + 1], world[at + 2]};
}

}  // namespace lobe::render
