#include "passes/picture.h"

#include <fmt/format.h>

#include <algorithm>

namespace lsde {

namespace {

void putLayer(ImageFile& file, const std::string& name, const RgbImage& image) {
    if (name == "normal") {
        for (int c = 0; c < 3; ++c) {
            auto& channel = file.channels[std::string("normal.") + "XYZ"[c]];
            for (const Rgb p : image.pixels) channel.push_back(p[c]);
        }
    } else if (name == "depth") {
        auto& channel = file.channels["depth.Z"];
        for (const Rgb p : image.pixels) channel.push_back(p.x);
    } else {
        file.setLayer(name, image);
    }
}

bool isBlackEverywhere(const RgbImage& image) {
    return std::all_of(image.pixels.begin(), image.pixels.end(), [](Rgb p) { return isBlack(p); });
}

}  // namespace

void PictureMean::add(const std::vector<RgbImage>& layers, double weight) {
    if (weight_ == 0) {
        sums_ = layers;
        weight_ = weight;
        return;
    }
    weight_ += weight;
    const auto share = static_cast<float>(weight / weight_);
    for (size_t i = 0; i < layers.size(); ++i)
        for (size_t p = 0; p < layers[i].pixels.size(); ++p)
            sums_[i].pixels[p] += (layers[i].pixels[p] - sums_[i].pixels[p]) * share;
}

void PictureMean::addError(const PictureError& error, double weight) {
    errorWeight_ += weight;
    const auto factor = static_cast<float>(square(weight));
    const auto add = [factor](std::vector<float>& sums, const std::vector<float>& variances) {
        sums.resize(variances.size());
        for (size_t i = 0; i < variances.size(); ++i) sums[i] += factor * variances[i];
    };
    add(errorSums_.camera, error.camera);
    add(errorSums_.photons, error.photons);
}

PictureError PictureMean::error() const {
    PictureError mean = errorSums_;
    const auto factor = static_cast<float>(1 / square(errorWeight_));
    for (auto* variances : {&mean.camera, &mean.photons})
        for (float& v : *variances) v *= factor;
    return mean;
}

ImageFile PictureMean::file(const std::vector<std::string>& names) const {
    ImageFile file;
    file.width = sums_[0].width;
    file.height = sums_[0].height;
    for (size_t i = 0; i < names.size(); ++i)
        if (names[i] != kOnlyLayer && !(names[i] == "unclassified" && isBlackEverywhere(sums_[i])))
            putLayer(file, names[i], sums_[i]);
    if (hasError()) file.channels["error.R"] = error().standardErrors();
    return file;
}

ExrMetadata describePicture(const Scene& scene, const Camera& camera, const RenderLayers& layers,
                            const PictureFacts& facts) {
    ExrMetadata m;
    m.text["software"] = fmt::format("lsde {}", LSDE_VERSION);
    m.text["integrator"] = facts.integrator;
    m.text["sceneHash"] = scene.hash();
    m.text["seed"] = std::to_string(facts.seed);
    m.text["photons"] = std::to_string(facts.photons);
    for (const PathLayer& layer : layers.filter().layers())
        if (layer.name != kOnlyLayer) m.text["paths." + layer.name] = layer.expression.text();
    if (!facts.only.empty()) m.text["only"] = facts.only;
    m.numbers["samplesPerPixel"] = static_cast<float>(facts.samples);
    m.whiteLuminance = 1.0F;  // one unit of radiance is one nit
    const Mat4 world = camera.worldToCamera();
    std::array<float, 16> rows{};
    for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < 4; ++j)
            rows[4 * i + j] = world[static_cast<int>(i)][static_cast<int>(j)];  // row vectors, as OpenEXR has them
    m.worldToCamera = rows;
    return m;
}

}  // namespace lsde
