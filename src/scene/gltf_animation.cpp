#include "scene/gltf_animation.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/gtc/quaternion.hpp>
#include <set>

namespace lsde {

namespace {

// Where a time lies among the keys: between two of them, or at one end.
struct Moment {
    size_t key = 0;
    double fraction = 0;  // of the way to the next key
    double interval = 0;  // s from this key to the next
};

// One sampler of an animation, asked for values of `width` numbers.
class Curve {
  public:
    Curve(const JsonObject& sampler, const GltfModel& model)
        : sampler_(sampler), input_(accessor("input", model)), output_(accessor("output", model)) {
        const std::string interpolation = sampler.has("interpolation") ? sampler.string("interpolation") : "LINEAR";
        step_ = interpolation == "STEP";
        cubic_ = interpolation == "CUBICSPLINE";
    }

    // The property's numbers at a time; of rotations, quaternions in glTF's order.
    std::vector<double> at(double seconds, bool rotation) const {
        const Moment m = momentOf(seconds);
        const size_t width = output_.count * output_.components / (input_.count * (cubic_ ? 3 : 1));
        std::vector<double> value = keyValue(m.key, 1, width);
        if (m.interval > 0 && cubic_)
            value = hermite(m, width);
        else if (m.interval > 0 && !step_)
            value = rotation ? turned(value, keyValue(m.key + 1, 1, width), m.fraction)
                             : mixed(value, keyValue(m.key + 1, 1, width), m.fraction);
        return rotation ? normalized(value) : value;
    }

  private:
    const GltfAccessor& accessor(const char* key, const GltfModel& model) const {
        const GltfAccessor& a = model.accessors[sampler_.reference(key, "accessor", model.accessors.size()).value()];
        a.checkSparse();
        return a;
    }

    Moment momentOf(double seconds) const {
        Moment m;
        double before = 0;
        for (size_t i = 0; i < input_.count; ++i) {
            const double t = input_.floats(i)[0];
            if (i > 0 && t <= before)
                sampler_.fail(fmt::format("key {} at {} s, expected later than the one before at {} s", i, t, before));
            if (t <= seconds) m = {i, 0, 0};
            if (t > seconds && i > 0 && before <= seconds) m = {i - 1, (seconds - before) / (t - before), t - before};
            before = t;
        }
        return m;
    }

    // Of a key; part of a cubic curve's: 0 tangent before, 1 value, 2 tangent after.
    std::vector<double> keyValue(size_t key, size_t part, size_t width) const {
        const size_t first = (cubic_ ? 3 * key + part : key) * width;
        std::vector<double> out;
        for (size_t i = 0; i < width; ++i)
            out.push_back(output_.floats((first + i) / output_.components)[(first + i) % output_.components]);
        return out;
    }

    static std::vector<double> mixed(const std::vector<double>& a, const std::vector<double>& b, double f) {
        std::vector<double> out;
        for (size_t i = 0; i < a.size(); ++i) out.push_back(a[i] + f * (b[i] - a[i]));
        return out;
    }
    static glm::dquat quaternion(const std::vector<double>& v) { return {v[3], v[0], v[1], v[2]}; }
    static std::vector<double> turned(const std::vector<double>& a, const std::vector<double>& b, double f) {
        const glm::dquat q = glm::slerp(quaternion(a), quaternion(b), f);
        return {q.x, q.y, q.z, q.w};
    }
    std::vector<double> normalized(const std::vector<double>& v) const {
        const double length = glm::length(quaternion(v));
        if (!(length > 0)) sampler_.fail("a rotation of 0, expected a unit quaternion");
        return {v[0] / length, v[1] / length, v[2] / length, v[3] / length};
    }
    // Appendix C.5.
    std::vector<double> hermite(const Moment& m, size_t width) const {
        const double t = m.fraction, t2 = t * t, t3 = t2 * t;
        const std::vector<double> a = keyValue(m.key, 1, width), out = keyValue(m.key, 2, width),
                                  b = keyValue(m.key + 1, 1, width), in = keyValue(m.key + 1, 0, width);
        std::vector<double> value;
        for (size_t i = 0; i < width; ++i)
            value.push_back((2 * t3 - 3 * t2 + 1) * a[i] + m.interval * (t3 - 2 * t2 + t) * out[i] +
                            (3 * t2 - 2 * t3) * b[i] + m.interval * (t3 - t2) * in[i]);
        return value;
    }

    const JsonObject& sampler_;
    const GltfAccessor& input_;
    const GltfAccessor& output_;
    bool step_ = false, cubic_ = false;
};

}  // namespace

void applyAnimations(Json& json, const std::string& file, const GltfModel& model, double seconds, Warnings& warnings) {
    const JsonObject root(json, "", file);
    std::set<std::pair<size_t, std::string>> moved;
    for (const JsonObject& animation : root.objects("animations", "animation")) {
        const std::vector<JsonObject> samplers = animation.objects("samplers", "sampler");
        for (const JsonObject& channel : animation.objects("channels", "channel")) {
            const JsonObject target = channel.object("target").value();
            const auto node = target.reference("node", "node", root.size("nodes"));
            const std::string path = target.string("path");
            if (!node || path == "pointer") {
                warnings.add("an animation of something other than a node is not shown", channel.where());
                continue;
            }
            if (!moved.emplace(*node, path).second) {
                warnings.add("several animations move the same node: the first is shown", channel.where());
                continue;
            }
            const Curve curve(samplers[channel.reference("sampler", "sampler", samplers.size()).value()], model);
            json["nodes"][*node][path] = curve.at(seconds, path == "rotation");
        }
    }
}

}  // namespace lsde
