#include "scene/gltf_buffers.h"

#include "scene/gltf_limits.h"
#include "scene/gltf_uri.h"
#include "store/file.h"

namespace lsde {

std::string GltfResources::behindUri(const JsonObject& object, uint64_t limit) const {
    const std::string uri = object.string("uri");
    return isDataUri(uri) ? decodeDataUri(uri) : readFile(resolveUri(folder, uri, allowOutside), limit);
}

GltfBuffers readBuffers(const GltfResources& resources, GltfSource& source) {
    GltfBuffers out;
    for (const JsonObject& object : resources.root.objects("buffers", "buffer")) {
        std::optional<std::string>& buffer = out.emplace_back();
        if (object.has("uri"))
            buffer = resources.behindUri(object, kMaxFileBytes);
        else if (out.size() == 1 && source.hasBinary)
            buffer = std::move(source.binary);
        else
            continue;
        const auto length = static_cast<size_t>(object.integer("byteLength", 1, 1, kMaxFileBytes));
        if (buffer->size() < length) object.fail("its file was cut while being read");
        buffer->resize(length);
    }
    return out;
}

}  // namespace lsde
