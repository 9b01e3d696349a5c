// Rendering the project's scenes small, and holding the pictures against known ones.
#pragma once

#include <doctest/doctest.h>

#include <cmath>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "image/exr.h"
#include "passes/integrators/registry.h"
#include "passes/render.h"
#include "scene/gltf.h"

namespace lsde::test {

inline const Scene& sceneOf(const std::string& name) {
    static std::map<std::string, std::unique_ptr<Scene>> loaded;
    std::unique_ptr<Scene>& scene = loaded[name];
    if (!scene) scene = std::make_unique<Scene>(loadGltf(std::string(LSDE_SCENES) + "/" + name + ".glb"));
    return *scene;
}

struct PictureSettings : RenderSettings {
    std::string integrator;
};

inline PictureSettings settingsFor(const std::string& integrator, int size, uint64_t samples,
                                   uint64_t photons = 200000) {
    PictureSettings s;
    s.integrator = integrator;
    s.size = {size, size};
    s.spp = samples;
    s.photons = photons;
    s.cache = false;
    return s;
}

inline RenderResult render(const Scene& scene, const PictureSettings& settings, uint64_t seed = 1, int threads = 0) {
    RunContext run(threads, seed);
    return renderPicture(scene, integratorByName(settings.integrator), settings, run);
}
inline RenderResult render(const std::string& scene, const PictureSettings& settings, uint64_t seed = 1,
                           int threads = 0) {
    return render(sceneOf(scene), settings, seed, threads);
}

// A picture by another program, and two independent halves of it (tests/data/ORIGIN.md).
struct Truth {
    RgbImage mean, a, b;
};
inline Truth truthOf(const std::string& name) {
    const auto read = [&](const std::string& half) {
        return readExr(std::string(LSDE_TEST_DATA) + "/reference/" + name + half + ".exr").layer("");
    };
    return {read(""), read(".a"), read(".b")};
}

// Averaged over squares of pixels.
inline RgbImage shrunk(const RgbImage& image, int width) {
    const int side = image.width / width;
    RgbImage out(width, image.height / side);
    for (int y = 0; y < out.height * side; ++y)
        for (int x = 0; x < width * side; ++x)
            out.at(x / side, y / side) += image.at(x, y) / static_cast<float>(side * side);
    return out;
}

inline double meanOf(const RgbImage& image) {
    double sum = 0;
    for (const Rgb p : image.pixels) sum += static_cast<double>(p.x) + p.y + p.z;
    return sum / (3 * static_cast<double>(image.pixels.size()));
}

// relMSE without the truth's own noise: mean of (I - A)(I - B) / (R^2 + 0.01), A and B independent halves.
inline double noiseCorrectedRelMse(const RgbImage& image, const Truth& truth) {
    double sum = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double v = image.pixels[i][c], r = truth.mean.pixels[i][c];
            sum += (v - truth.a.pixels[i][c]) * (v - truth.b.pixels[i][c]) / (r * r + 0.01);
        }
    return sum / (3 * static_cast<double>(image.pixels.size()));
}

// One picture for each seed from 1 on.
inline std::vector<RenderResult> pictures(const Scene& scene, const PictureSettings& settings, uint64_t seeds) {
    std::vector<RenderResult> out;
    for (uint64_t seed = 1; seed <= seeds; ++seed) {
        RunContext run(0, seed);
        out.push_back(renderPicture(scene, integratorByName(settings.integrator), settings, run));
    }
    return out;
}

// The mean over blocks of pixels, and its standard error, from several pictures.
struct Estimate {
    std::vector<double> mean, error;
};
inline Estimate estimate(const std::vector<RenderResult>& pictures, int blocks, const std::string& layer,
                         const std::function<float(Rgb)>& valueOf = luminance) {
    const auto n = static_cast<size_t>(blocks) * static_cast<size_t>(blocks);
    std::vector<double> sum(n), sum2(n);
    for (const RenderResult& picture : pictures) {
        const RgbImage image = picture.image.layer(layer);
        const int side = image.width / blocks;
        for (int by = 0; by < blocks; ++by)
            for (int bx = 0; bx < blocks; ++bx) {
                double block = 0;
                for (int y = by * side; y < (by + 1) * side; ++y)
                    for (int x = bx * side; x < (bx + 1) * side; ++x) block += valueOf(image.at(x, y));
                block /= side * side;
                const size_t at = static_cast<size_t>(by) * static_cast<size_t>(blocks) + static_cast<size_t>(bx);
                sum[at] += block;
                sum2[at] += block * block;
            }
    }
    Estimate e;
    const auto k = static_cast<double>(pictures.size());
    for (size_t i = 0; i < n; ++i) {
        e.mean.push_back(sum[i] / k);
        e.error.push_back(std::sqrt(std::max(0.0, sum2[i] / k - e.mean[i] * e.mean[i]) / (k - 1)));
    }
    return e;
}
inline Estimate estimate(const Scene& scene, const PictureSettings& settings, uint64_t seeds, int blocks,
                         const std::string& layer = "") {
    return estimate(pictures(scene, settings, seeds), blocks, layer);
}
inline Estimate estimate(const std::string& scene, const PictureSettings& settings, uint64_t seeds, int blocks,
                         const std::string& layer = "") {
    return estimate(sceneOf(scene), settings, seeds, blocks, layer);
}

// Blocks agree within five standard errors and the bias that a kernel of some pixels' width is allowed.
inline void checkAgreement(const Estimate& a, const Estimate& b, double bias) {
    REQUIRE(a.mean.size() == b.mean.size());
    double sumA = 0, sumB = 0, error2 = 0;
    for (size_t i = 0; i < a.mean.size(); ++i) {
        CAPTURE(i);
        CAPTURE(a.mean[i]);
        CAPTURE(b.mean[i]);
        CHECK(std::fabs(a.mean[i] - b.mean[i]) <
              5 * std::hypot(a.error[i], b.error[i]) + bias * std::max(a.mean[i], b.mean[i]) + 1e-5);
        sumA += a.mean[i];
        sumB += b.mean[i];
        error2 += a.error[i] * a.error[i] + b.error[i] * b.error[i];
    }
    CAPTURE(sumA / sumB);
    CHECK(std::fabs(sumA - sumB) < 4 * std::sqrt(error2) + 0.003 * sumB);
}

}  // namespace lsde::test
