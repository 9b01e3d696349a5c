// The one file that includes Embree.
#include "scene/accel.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <cstring>

#include "base/error.h"

namespace lsde {

namespace {

// Embree builds its trees with TBB, of which ThreadSanitizer reports races that are none.
#ifdef LSDE_PARALLEL_STD
constexpr const char* kDeviceConfig = "threads=1";
#else
constexpr const char* kDeviceConfig = nullptr;
#endif

struct CollectContext {
    RTCIntersectContext context;
    std::vector<Hit>* hits;
};

// Records every hit and lets none end the ray.
void collectHit(const RTCFilterFunctionNArguments* args) {
    auto* collect = reinterpret_cast<CollectContext*>(args->context);
    for (unsigned i = 0; i < args->N; ++i) {
        if (args->valid[i] == 0) continue;
        collect->hits->push_back({RTCRayN_tfar(args->ray, args->N, i), RTCHitN_geomID(args->hit, args->N, i),
                                  RTCHitN_primID(args->hit, args->N, i), RTCHitN_u(args->hit, args->N, i),
                                  RTCHitN_v(args->hit, args->N, i)});
        args->valid[i] = 0;
    }
}

RTCRay toEmbree(const Ray& ray) {
    RTCRay r{};
    r.org_x = ray.origin.x;
    r.org_y = ray.origin.y;
    r.org_z = ray.origin.z;
    r.dir_x = ray.direction.x;
    r.dir_y = ray.direction.y;
    r.dir_z = ray.direction.z;
    r.tfar = ray.tMax;
    r.mask = ~0U;
    return r;
}

}  // namespace

struct Accel::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;

    Impl() = default;
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;
    ~Impl() {
        if (scene != nullptr) rtcReleaseScene(scene);
        if (device != nullptr) rtcReleaseDevice(device);
    }
    void check(const char* what) const {
        const RTCError code = rtcGetDeviceError(device);
        if (code != RTC_ERROR_NONE)
            throw Error(std::string("Embree: ") + what + " failed with error " + std::to_string(code) +
                        (code == RTC_ERROR_OUT_OF_MEMORY ? " (out of memory)" : ""));
    }
    void add(const Mesh& mesh) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                                  mesh.positions.size());
        auto* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                                mesh.triangles.size());
        check("allocating geometry");
        if (positions != nullptr) std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
        if (indices != nullptr) std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);  // geometry ids count up from 0: the mesh's index
        rtcReleaseGeometry(geometry);
    }
};

Accel::Accel(std::span<const Mesh> meshes) : impl_(std::make_unique<Impl>()) {
    impl_->device = rtcNewDevice(kDeviceConfig);
    if (impl_->device == nullptr) throw Error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
    impl_->scene = rtcNewScene(impl_->device);
    // Robust: no cracks between triangles, so that no light leaks out of a closed solid.
    rtcSetSceneFlags(impl_->scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    for (const Mesh& mesh : meshes) impl_->add(mesh);
    rtcCommitScene(impl_->scene);
    impl_->check("building the scene");
}

Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;

bool Accel::intersect(const Ray& ray, Hit& hit) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRayHit query{};
    query.ray = toEmbree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &context, &query);
    if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = {query.ray.tfar, query.hit.geomID, query.hit.primID, query.hit.u, query.hit.v};
    return true;
}

bool Accel::occluded(const Ray& ray) const {
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    RTCRay query = toEmbree(ray);
    rtcOccluded1(impl_->scene, &context, &query);
    return query.tfar < 0;
}

void Accel::allHits(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    CollectContext collect{};
    rtcInitIntersectContext(&collect.context);
    collect.context.filter = collectHit;
    collect.hits = &hits;
    RTCRayHit query{};
    query.ray = toEmbree(ray);
    query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &collect.context, &query);
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        if (a.t != b.t) return a.t < b.t;
        return a.mesh != b.mesh ? a.mesh < b.mesh : a.triangle < b.triangle;
    });
    // A ray through a shared edge may report a triangle twice.
    hits.erase(std::unique(hits.begin(), hits.end(),
                           [](const Hit& a, const Hit& b) { return a.mesh == b.mesh && a.triangle == b.triangle; }),
               hits.end());
}

}  // namespace lsde
