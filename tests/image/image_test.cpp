#include "image/image.h"

#include <doctest/doctest.h>

#include "store/fixture.h"

using namespace lsde;

namespace {

RgbImage ramp(int width, int height) {
    RgbImage image(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) image.at(x, y) = Rgb(x, y, x + 10 * y);
    return image;
}

}  // namespace

TEST_CASE("a layer comes back as it was set") {
    ImageFile file;
    file.setLayer("", RgbImage(3, 2, Rgb(1)));
    file.setLayer("caustic", ramp(3, 2));
    CHECK(file.width == 3);
    CHECK(file.height == 2);
    CHECK(file.channels.size() == 6);
    CHECK(file.channels.at("caustic.B") == std::vector<float>{0, 1, 2, 10, 11, 12});
    CHECK(file.layer("caustic").pixels == ramp(3, 2).pixels);
    CHECK(file.layer("").pixels == RgbImage(3, 2, Rgb(1)).pixels);
}

TEST_CASE("only channels R, G and B together are a layer") {
    ImageFile file;
    file.setLayer("direct", RgbImage(1, 1));
    file.setLayer("caustic", RgbImage(1, 1));
    file.channels["depth.Z"] = {0};
    file.channels["half.R"] = {0};
    CHECK(file.layerNames() == std::vector<std::string>{"caustic", "direct"});
    file.setLayer("", RgbImage(1, 1));
    CHECK(file.layerNames() == std::vector<std::string>{"", "caustic", "direct"});
}

TEST_CASE("a missing layer is refused with the channels there are") {
    ImageFile file;
    file.setLayer("", RgbImage(1, 1));
    CHECK(test::errorOf([&] { file.layer("caustic"); }) == "no channel \"caustic.R\", expected one of: B, G, R");
}
