// The one file that includes Embree.
#include "scene/accel.h"

#include <embree3/rtcore.h>

#include <algorithm>
#include <array>
#include <cstring>

#include "base/error.h"
#include "base/hash.h"

namespace lsde {

namespace {

// Embree builds its trees with TBB, of which ThreadSanitizer reports races that are none.
#ifdef LSDE_PARALLEL_STD
constexpr const char* kDeviceConfig = "threads=1";
#else
constexpr const char* kDeviceConfig = nullptr;
#endif

// What becomes of surfaces that cover only part.
enum class Partly : uint8_t { ByChance, Collected, AllThere };

// A ray on its way, as the filters see it. Embree hands them its context, the first member.
struct Query {
    RTCIntersectContext context;
    const Ray& ray;
    Partly partly;
    std::vector<Hit>* hits = nullptr;  // collected

    Query(const Ray& r, Partly p, std::vector<Hit>* h = nullptr) : ray(r), partly(p), hits(h) {
        rtcInitIntersectContext(&context);
    }
};

// Rays are asked for one by one.
Hit hitOf(const RTCFilterFunctionNArguments* args) {
    return {RTCRayN_tfar(args->ray, 1, 0), RTCHitN_geomID(args->hit, 1, 0), RTCHitN_primID(args->hit, 1, 0),
            RTCHitN_u(args->hit, 1, 0), RTCHitN_v(args->hit, 1, 0)};
}

// Records every hit and lets none end the ray.
void collectHit(const RTCFilterFunctionNArguments* args) {
    if (args->valid[0] == 0) return;
    reinterpret_cast<Query*>(args->context)->hits->push_back(hitOf(args));
    args->valid[0] = 0;
}

// Sorted, each once: a ray through a shared edge may report a triangle twice.
void putInOrder(std::vector<Hit>& hits) {
    std::sort(hits.begin(), hits.end(), [](const Hit& a, const Hit& b) {
        if (a.t != b.t) return a.t < b.t;
        return a.mesh != b.mesh ? a.mesh < b.mesh : a.triangle < b.triangle;
    });
    hits.erase(std::unique(hits.begin(), hits.end(),
                           [](const Hit& a, const Hit& b) { return a.mesh == b.mesh && a.triangle == b.triangle; }),
               hits.end());
}

// Uniform in [0,1), the same for the same ray and triangle.
float chanceOf(const Ray& ray, const Hit& hit) {
    std::array<uint32_t, 6> bits;
    const std::array<Vec3, 2> line = {ray.origin, ray.direction};
    static_assert(sizeof bits == sizeof line);
    std::memcpy(bits.data(), line.data(), sizeof bits);
    uint64_t h = (uint64_t{hit.mesh} << 32) | hit.triangle;
    for (size_t i = 0; i < bits.size(); i += 2) h = hashCombine(h, (uint64_t{bits[i]} << 32) | bits[i + 1]);
    return toUnitFloat(static_cast<uint32_t>(h >> 32));
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

RTCRayHit toEmbreeHit(const Ray& ray) {
    RTCRayHit r{};
    r.ray = toEmbree(ray);
    r.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    return r;
}

}  // namespace

struct Accel::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    PartialCoverage coverage;
    bool hasPartial = false;

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
    // Embree's filter of hits of meshes that cover only part: takes back the hit where the ray goes on.
    static void filterPartial(const RTCFilterFunctionNArguments* args) {
        const Impl& accel = *static_cast<const Impl*>(args->geometryUserPtr);
        const auto& query = *reinterpret_cast<const Query*>(args->context);
        if (args->valid[0] == 0 || query.partly == Partly::AllThere) return;
        const Hit hit = hitOf(args);
        const float covered = accel.coverage.at(hit);
        if (query.partly == Partly::ByChance) {
            if (!(chanceOf(query.ray, hit) < covered)) args->valid[0] = 0;
        } else if (covered < 1) {
            query.hits->push_back(hit);
            args->valid[0] = 0;
        }
    }
    void add(const Mesh& mesh, bool partial) {
        RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* positions = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(Vec3),
                                                  mesh.positions.size());
        auto* indices = rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle),
                                                mesh.triangles.size());
        check("allocating geometry");
        if (positions != nullptr) std::memcpy(positions, mesh.positions.data(), mesh.positions.size() * sizeof(Vec3));
        if (indices != nullptr) std::memcpy(indices, mesh.triangles.data(), mesh.triangles.size() * sizeof(Triangle));
        if (partial) {
            hasPartial = true;
            rtcSetGeometryUserData(geometry, this);
            rtcSetGeometryIntersectFilterFunction(geometry, &filterPartial);
            rtcSetGeometryOccludedFilterFunction(geometry, &filterPartial);
        }
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(scene, geometry);  // geometry ids count up from 0: the mesh's index
        rtcReleaseGeometry(geometry);
    }
};

Accel::Accel(std::span<const Mesh> meshes, PartialCoverage coverage) : impl_(std::make_unique<Impl>()) {
    impl_->coverage = std::move(coverage);
    impl_->device = rtcNewDevice(kDeviceConfig);
    if (impl_->device == nullptr) throw Error("Embree: no device, error " + std::to_string(rtcGetDeviceError(nullptr)));
    impl_->scene = rtcNewScene(impl_->device);
    // Robust: no cracks between triangles, so that no light leaks out of a closed solid.
    rtcSetSceneFlags(impl_->scene,
                     static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    for (size_t i = 0; i < meshes.size(); ++i) impl_->add(meshes[i], impl_->coverage.partial[i]);
    rtcCommitScene(impl_->scene);
    impl_->check("building the scene");
}

Accel::~Accel() = default;
Accel::Accel(Accel&&) noexcept = default;

bool Accel::intersect(const Ray& ray, Hit& hit) const {
    Query query(ray, Partly::ByChance);
    RTCRayHit found = toEmbreeHit(ray);
    rtcIntersect1(impl_->scene, &query.context, &found);
    if (found.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;
    hit = {found.ray.tfar, found.hit.geomID, found.hit.primID, found.hit.u, found.hit.v};
    return true;
}

bool Accel::occluded(const Ray& ray) const {
    Query query(ray, Partly::ByChance);
    RTCRay found = toEmbree(ray);
    rtcOccluded1(impl_->scene, &query.context, &found);
    return found.tfar < 0;
}

float Accel::transmittance(const Ray& ray, std::vector<Hit>& hits) const {
    if (!impl_->hasPartial) return occluded(ray) ? 0.0F : 1.0F;
    hits.clear();
    Query query(ray, Partly::Collected, &hits);
    RTCRay found = toEmbree(ray);
    rtcOccluded1(impl_->scene, &query.context, &found);
    if (found.tfar < 0) return 0;
    putInOrder(hits);  // Embree's order would round differently from build to build
    float left = 1;
    for (const Hit& hit : hits) left *= 1 - impl_->coverage.at(hit);
    return left;
}

bool Accel::isThere(const Ray& ray, const Hit& hit) const {
    return !impl_->coverage.partial[hit.mesh] || chanceOf(ray, hit) < impl_->coverage.at(hit);
}

void Accel::allHits(const Ray& ray, std::vector<Hit>& hits) const {
    hits.clear();
    Query query(ray, Partly::AllThere, &hits);
    query.context.filter = collectHit;
    RTCRayHit found = toEmbreeHit(ray);
    rtcIntersect1(impl_->scene, &query.context, &found);
    putInOrder(hits);
}

}  // namespace lsde
