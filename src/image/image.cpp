#include "image/image.h"

#include <fmt/format.h>

#include <array>

#include "base/error.h"

namespace lsde {

namespace {

constexpr std::array<const char*, 3> kRgb = {"R", "G", "B"};

std::string channelName(std::string_view layer, const char* channel) {
    return layer.empty() ? channel : fmt::format("{}.{}", layer, channel);
}

}  // namespace

RgbImage ImageFile::layer(std::string_view name) const {
    RgbImage image(width, height);
    for (int c = 0; c < 3; ++c) {
        const auto channel = channels.find(channelName(name, kRgb[static_cast<size_t>(c)]));
        if (channel == channels.end()) {
            std::string present;
            for (const auto& [other, values] : channels)
                present += fmt::format("{}{}", present.empty() ? "" : ", ", other);
            throw Error(fmt::format("no channel \"{}\", expected one of: {}",
                                    channelName(name, kRgb[static_cast<size_t>(c)]), present));
        }
        LSDE_ASSERT(channel->second.size() == image.pixels.size());
        for (size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i][c] = channel->second[i];
    }
    return image;
}

void ImageFile::setLayer(std::string_view name, const RgbImage& image) {
    if (channels.empty()) {
        width = image.width;
        height = image.height;
    }
    LSDE_ASSERT(image.width == width && image.height == height);
    for (int c = 0; c < 3; ++c) {
        auto& channel = channels[channelName(name, kRgb[static_cast<size_t>(c)])];
        channel.resize(image.pixels.size());
        for (size_t i = 0; i < image.pixels.size(); ++i) channel[i] = image.pixels[i][c];
    }
}

std::vector<std::string> ImageFile::layerNames() const {
    std::vector<std::string> names;
    const auto complete = [&](std::string_view name) {
        return channels.contains(channelName(name, "R")) && channels.contains(channelName(name, "G")) &&
               channels.contains(channelName(name, "B"));
    };
    if (complete("")) names.emplace_back();
    for (const auto& [channel, values] : channels) {
        if (!channel.ends_with(".R")) continue;
        const std::string name = channel.substr(0, channel.size() - 2);
        if (!name.empty() && complete(name)) names.push_back(name);
    }
    return names;
}

}  // namespace lsde
