// A part of a picture.
#pragma once

namespace lsde {

struct Crop {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;  // pixels of the whole picture, [x0, x1) x [y0, y1)
};

}  // namespace lsde
