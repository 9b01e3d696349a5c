#include "image/hdr.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <string_view>
#include <tuple>

#include "base/error.h"
#include "store/file.h"

namespace lsde {

namespace {

using Rgbe = std::array<uint8_t, 4>;

Rgb decode(Rgbe p) {
    if (p[3] == 0) return Rgb(0);
    const float scale = std::ldexp(1.0F, p[3] - 136);
    return {static_cast<float>(p[0]) * scale, static_cast<float>(p[1]) * scale, static_cast<float>(p[2]) * scale};
}

// Format: Ward, "Real Pixels" (Graphics Gems II, 1991), and the file format page of Radiance.
class HdrReader {
  public:
    HdrReader(std::string_view bytes, int64_t maxPixels) : rest_(bytes), maxPixels_(maxPixels) {}

    RgbImage read() {
        readHeader();
        RgbImage image;
        std::tie(image.width, image.height) = readSize();
        std::vector<Rgbe> row(static_cast<size_t>(image.width));
        for (int y = 0; y < image.height; ++y) {
            row_ = y;
            readRow(row);
            // Memory is taken row by row, so that a file that is cut short takes little.
            for (const Rgbe pixel : row) image.pixels.push_back(decode(pixel) / exposure_);
        }
        return image;
    }

  private:
    std::string_view line() {
        const size_t end = rest_.find('\n');
        if (end == std::string_view::npos) throw Error("the header is cut short");
        std::string_view out = rest_.substr(0, end);
        rest_.remove_prefix(end + 1);
        if (out.ends_with('\r')) out.remove_suffix(1);
        return out;
    }

    void readHeader() {
        if (!rest_.starts_with("#?")) throw Error("not a Radiance picture: expected \"#?\" at its beginning");
        bool rgbe = false;
        for (line();;) {
            const std::string_view entry = line();
            if (entry.empty()) break;
            if (entry.starts_with("FORMAT=")) {
                rgbe = entry == "FORMAT=32-bit_rle_rgbe";
                if (!rgbe) throw Error(fmt::format("{}, expected FORMAT=32-bit_rle_rgbe", entry));
            }
            if (entry.starts_with("EXPOSURE=")) {
                const std::string value(entry.substr(9));
                exposure_ *= std::strtof(value.c_str(), nullptr);
                if (!(exposure_ > 0) || !std::isfinite(exposure_))
                    throw Error(fmt::format("EXPOSURE={}, expected a number > 0", value));
            }
        }
        if (!rgbe) throw Error("no FORMAT line, expected FORMAT=32-bit_rle_rgbe");
    }

    std::pair<int, int> readSize() {
        const std::string resolution(line());
        long height = 0, width = 0;
        char end = 0;
        if (std::sscanf(resolution.c_str(), "-Y %9ld +X %9ld%c", &height, &width, &end) != 2 || width < 1 || height < 1)
            throw Error(fmt::format("resolution \"{}\", expected -Y HEIGHT +X WIDTH", resolution));
        if (static_cast<int64_t>(width) * height > maxPixels_)
            throw Error(fmt::format("{}x{} pixels, expected at most {}", width, height, maxPixels_));
        return {static_cast<int>(width), static_cast<int>(height)};
    }

    uint8_t byte() {
        if (rest_.empty()) throw Error(fmt::format("row {} is cut short", row_));
        const auto value = static_cast<uint8_t>(rest_.front());
        rest_.remove_prefix(1);
        return value;
    }

    Rgbe pixel() {
        Rgbe p{};
        for (uint8_t& c : p) c = byte();
        return p;
    }

    void readRow(std::vector<Rgbe>& row) {
        const Rgbe first = pixel();
        const bool byChannel = first[0] == 2 && first[1] == 2 && first[2] < 128;
        if (!byChannel || row.size() < 8 || row.size() > 0x7fff) return readFlat(row, first);
        const size_t width = static_cast<size_t>(first[2]) << 8 | first[3];
        if (width != row.size())
            throw Error(fmt::format("row {} holds {} pixels, expected {}", row_, width, row.size()));
        for (size_t c = 0; c < 4; ++c)
            for (size_t x = 0; x < row.size();) {
                const uint8_t code = byte();
                const size_t count = code > 128 ? code - 128U : code;
                if (count == 0 || count > row.size() - x)
                    throw Error(fmt::format("row {}: a run of {} pixels at {}, expected 1 to {}", row_, count, x,
                                            row.size() - x));
                const uint8_t repeated = code > 128 ? byte() : 0;
                for (size_t i = 0; i < count; ++i) row[x++][c] = code > 128 ? repeated : byte();
            }
    }

    // Pixel by pixel; (1, 1, 1, n) repeats the one before n times, further ones in a row count in units of 256.
    void readFlat(std::vector<Rgbe>& row, Rgbe p) {
        int shift = 0;
        for (size_t x = 0;;) {
            if (p[0] == 1 && p[1] == 1 && p[2] == 1) {
                const size_t count = static_cast<size_t>(p[3]) << shift;
                if (x == 0 || count > row.size() - x)
                    throw Error(fmt::format("row {}: repeats {} pixels at {} of {}", row_, count, x, row.size()));
                for (size_t i = 0; i < count; ++i, ++x) row[x] = row[x - 1];
                shift = std::min(shift + 8, 24);
            } else {
                row[x++] = p;
                shift = 0;
            }
            if (x == row.size()) return;
            p = pixel();
        }
    }

    std::string_view rest_;
    int64_t maxPixels_;
    float exposure_ = 1;
    int row_ = 0;
};

}  // namespace

RgbImage readHdr(const std::filesystem::path& path, int64_t maxPixels) {
    constexpr uint64_t kMostBytes = uint64_t{1} << 32;
    const std::string bytes = readFile(path, kMostBytes);
    try {
        return HdrReader(bytes, maxPixels).read();
    } catch (const Error& e) {
        throw Error(fmt::format("{}: {}", path.string(), e.what()));
    }
}

}  // namespace lsde
