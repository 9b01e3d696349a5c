// The same scene, settings and seed: the same bytes, for any number of threads or shards.
#include <doctest/doctest.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <utility>

#include "passes/pictures.h"
#include "passes/sample_plan.h"

using namespace lsde;
using namespace lsde::test;

namespace {

class Folder {
  public:
    Folder() : path_(std::filesystem::temp_directory_path() / ("lsde-passes-test-" + std::to_string(::getpid()))) {
        std::filesystem::create_directories(path_);
    }
    ~Folder() { std::filesystem::remove_all(path_); }
    Folder(const Folder&) = delete;
    Folder& operator=(const Folder&) = delete;
    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  private:
    std::filesystem::path path_;
};

std::string bytesOf(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::ostringstream out;
    out << in.rdbuf();
    return out.str();
}

void emitTo(const std::filesystem::path& file, const std::string& scene, IndexRange range, int threads) {
    EmitSettings s;
    s.photons = 40000;
    s.store = Store::All;
    s.range = range;
    RunContext run(threads, 3);
    writePhotonMap(file, emitPhotons(sceneOf(scene), s, run), run);
}

}  // namespace

TEST_CASE("maps of one and of three threads are the same bytes, and so is the merger of four shards in any order") {
    const Folder folder;
    for (const char* scene : {"glass-sphere-small", "cornell-small"}) {
        emitTo(folder / "one", scene, {}, 1);
        emitTo(folder / "three", scene, {}, 3);
        const std::string whole = bytesOf(folder / "one");
        REQUIRE(!whole.empty());
        CHECK(whole == bytesOf(folder / "three"));
        std::vector<std::filesystem::path> shards;
        for (const uint64_t i : {3, 1, 4, 2}) {
            shards.push_back(folder / ("shard" + std::to_string(i)));
            emitTo(shards.back(), scene, shardRange(40000, i, 4), 2);
        }
        RunContext run(2, 3);
        writePhotonMap(folder / "merged", mergePhotonMaps(shards, run), run);
        CHECK(whole == bytesOf(folder / "merged"));
    }
}

TEST_CASE("pictures of one and of three threads are the same, and of one pass and of several") {
    for (const char* integrator : {"photon", "path", "light"}) {
        CAPTURE(integrator);
        const PictureSettings s = settingsFor(integrator, 24, 5, 20000);
        CHECK(render("cornell-small", s, 7, 1).picture.pixels == render("cornell-small", s, 7, 3).picture.pixels);
    }
}

TEST_CASE("a crop shows the pixels of the whole picture") {
    // Photon mapping's later samples go where the crop, or the whole, is noisy.
    const std::pair<const char*, uint64_t> runs[] = {{"photon", SamplePlan::kUniform}, {"path", 5}};
    for (const auto& [integrator, samples] : runs) {
        CAPTURE(integrator);
        PictureSettings s = settingsFor(integrator, 24, samples, 20000);
        const RgbImage whole = render("glass-sphere-small", s).picture;
        s.crop = Crop{5, 7, 15, 20};
        const RgbImage crop = render("glass-sphere-small", s).picture;
        REQUIRE(crop.width == 10);
        REQUIRE(crop.height == 13);
        for (int y = 0; y < 13; ++y)
            for (int x = 0; x < 10; ++x) CHECK(crop.at(x, y) == whole.at(x + 5, y + 7));
    }
}
