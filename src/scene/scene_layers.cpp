// What lies on and in opaque surfaces at a hit: brushed grain, thin films, cloth and varnish.
#include "scene/scene.h"
#include "scene/tangent_frame.h"

namespace lsde {

Bsdf Scene::layeredBsdf(const Surface& s, MetalRoughBsdf base) const {
    const Material& m = material(s);
    if (m.anisotropy) base.direction = anisotropyDirection(s, base.anisotropy);
    if (m.iridescence) base.film = film(s);
    LayeredBsdf b{base};
    if (m.sheen) b.sheen = sheen(s);
    if (m.clearcoat) b.coat = clearcoat(s);
    if (b.sheen.empty() && b.coat.empty()) return base;
    return b;
}

// Of greater roughness, in the frame of the shading normal (KHR_materials_anisotropy).
Vec2 Scene::anisotropyDirection(const Surface& s, float& strength) const {
    const AnisotropyProperties& a = *material(s).anisotropy;
    const Mesh& mesh = description_.meshes[s.mesh];
    const int texCoord = a.texture ? a.texture.texCoord : material(s).normalTexture.texCoord;
    const TangentFrame frame = tangentFrame(mesh, mesh.triangles[s.triangle], s.u, s.v, s.ns, texCoord);
    strength = a.strength;
    Vec2 inTangents(1, 0);
    if (a.texture) {
        const Vec4 texel = sample(s, a.texture, false);
        const Vec2 stored = 2.0F * Vec2(texel) - Vec2(1);
        const float length = glm::length(stored);
        if (length > 0) inTangents = stored / length;
        strength *= texel.z;
    }
    const float c = std::cos(a.rotation), sine = std::sin(a.rotation);
    const Vec2 turned(c * inTangents.x - sine * inTangents.y, sine * inTangents.x + c * inTangents.y);
    const Vec3 local = Frame(s.ns).toLocal(turned.x * frame.tangent + turned.y * frame.bitangent);
    return glm::normalize(Vec2(local));
}

ThinFilm Scene::film(const Surface& s) const {
    const IridescenceProperties& i = *material(s).iridescence;
    ThinFilm out{i.factor, i.ior, i.thicknessMaximum};
    if (i.texture) out.factor *= sample(s, i.texture, false).x;
    if (i.thicknessTexture) {
        const float t = sample(s, i.thicknessTexture, false).y;
        out.thickness = i.thicknessMinimum + t * (i.thicknessMaximum - i.thicknessMinimum);
    }
    return out;
}

Sheen Scene::sheen(const Surface& s) const {
    const SheenProperties& p = *material(s).sheen;
    Sheen out{p.color, p.roughness};
    if (p.colorTexture) out.color *= Vec3(sample(s, p.colorTexture, true));
    if (p.roughnessTexture) out.roughness *= sample(s, p.roughnessTexture, false).w;
    return out;
}

Clearcoat Scene::clearcoat(const Surface& s) const {
    const ClearcoatProperties& p = *material(s).clearcoat;
    Clearcoat out{p.factor, p.roughness};
    if (p.texture) out.factor *= sample(s, p.texture, false).x;
    if (p.roughnessTexture) out.roughness *= sample(s, p.roughnessTexture, false).y;
    Vec3 normal = vertexNormal(s);
    if (p.normalTexture) normal = mappedNormal(s, normal, p.normalTexture, p.normalScale);
    const Vec3 local = Frame(s.ns).toLocal(normal);
    // Of two normals that do not see each other's surface the base's holds.
    if (local.z > 0 && normal != s.ns) out.normal = local;
    return out;
}

}  // namespace lsde
