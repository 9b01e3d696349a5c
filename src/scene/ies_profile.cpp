#include "scene/ies_profile.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "base/error.h"

namespace lsde {

namespace {

constexpr float kDegree = kPi / 180;
constexpr int kMostAngles = 4096, kMostValues = 1 << 20;

// The numbers after the TILT line, in the order in which they come.
class Numbers {
  public:
    explicit Numbers(std::string_view text) : rest_(text) {}

    float next(const char* what) {
        constexpr std::string_view kBetween = " \t\r\n,";
        rest_.remove_prefix(std::min(rest_.find_first_not_of(kBetween), rest_.size()));
        const std::string_view token = rest_.substr(0, rest_.find_first_of(kBetween));
        if (token.empty()) throw Error(fmt::format("IES profile: ends before {}", what));
        rest_.remove_prefix(token.size());
        const char* const begin = token.data() + (token.front() == '+' ? 1 : 0);
        float value = 0;
        const auto [end, error] = std::from_chars(begin, token.data() + token.size(), value);
        if (error != std::errc() || end != token.data() + token.size() || !std::isfinite(value))
            throw Error(fmt::format("IES profile: {} \"{}\", expected a number", what, token.substr(0, 40)));
        return value;
    }
    int count(const char* what, int least, int most) {
        const float value = next(what);
        if (!(value >= static_cast<float>(least) && value <= static_cast<float>(most)) || value != std::floor(value))
            throw Error(
                fmt::format("IES profile: {} {}, expected a whole number from {} to {}", what, value, least, most));
        return static_cast<int>(value);
    }
    float notNegative(const char* what) {
        const float value = next(what);
        if (!(value >= 0)) throw Error(fmt::format("IES profile: {} {}, expected 0 or more", what, value));
        return value;
    }
    std::vector<float> angles(const char* what, int count) {
        std::vector<float> out;
        for (int i = 0; i < count; ++i) {
            out.push_back(next(what));
            if (i > 0 && !(out[static_cast<size_t>(i)] > out[static_cast<size_t>(i) - 1]))
                throw Error(fmt::format("IES profile: {} {} after {}, expected more", what, out.back(),
                                        out[static_cast<size_t>(i) - 1]));
        }
        return out;
    }
    void skip(int count, const char* what) {
        for (int i = 0; i < count; ++i) next(what);
    }

  private:
    std::string_view rest_;
};

void expectWithin(const char* what, const std::vector<float>& angles, float lo, float hi) {
    if (angles.front() < lo || angles.back() > hi)
        throw Error(fmt::format("IES profile: {} from {} to {} degrees, expected within {} to {}", what, angles.front(),
                                angles.back(), lo, hi));
}

// The interval that holds x, and where x lies in it; false: outside.
bool find(const std::vector<float>& angles, float x, size_t& first, float& share) {
    // Directions on the rim of what was measured are part of it, however they are rounded.
    constexpr float kSlack = 1e-3F;
    if (x < angles.front() - kSlack || x > angles.back() + kSlack) return false;
    const auto above = std::upper_bound(angles.begin() + 1, angles.end() - 1, x);
    first = static_cast<size_t>(above - angles.begin()) - 1;
    share = std::clamp((x - angles[first]) / (angles[first + 1] - angles[first]), 0.0F, 1.0F);
    return true;
}

}  // namespace

IesProfile::IesProfile(std::string_view text) {
    const size_t tilt = text.find("TILT=");
    if (tilt == std::string_view::npos) throw Error("IES profile: no line \"TILT=\", expected a file of LM-63");
    const size_t end = std::min(text.find('\n', tilt), text.size());
    const std::string_view lamp = text.substr(tilt + 5, end - tilt - 5);
    tilted_ = lamp.substr(0, 4) != "NONE";
    Numbers numbers(text.substr(end));
    if (lamp.substr(0, 7) == "INCLUDE") {
        numbers.next("lamp's geometry");
        numbers.skip(2 * numbers.count("number of tilt angles", 1, kMostAngles), "tilt");
    }
    numbers.skip(2, "number of lamps and their lumens");
    float scale = numbers.notNegative("candela multiplier");
    const int verticals = numbers.count("number of vertical angles", 2, kMostAngles);
    const int horizontals = numbers.count("number of horizontal angles", 1, kMostAngles);
    if (verticals * horizontals > kMostValues)
        throw Error(fmt::format("IES profile: {} x {} angles, limit {}", verticals, horizontals, kMostValues));
    photometry_ = static_cast<Photometry>(numbers.count("photometric type", 1, 3));
    numbers.skip(4, "units and size");
    scale *= numbers.notNegative("ballast factor");
    numbers.skip(2, "input watts");
    vertical_ = numbers.angles("vertical angle", verticals);
    horizontal_ = numbers.angles("horizontal angle", horizontals);
    const bool polar = photometry_ == Photometry::C;
    expectWithin("vertical angles", vertical_, polar ? 0.0F : -90.0F, polar ? 180.0F : 90.0F);
    expectWithin("horizontal angles", horizontal_, polar ? 0.0F : -90.0F, polar ? 360.0F : 90.0F);
    for (int i = 0; i < verticals * horizontals; ++i) values_.push_back(numbers.notNegative("candela value"));
    const float most = *std::max_element(values_.begin(), values_.end());
    if (most > 0)
        for (float& value : values_) value /= most;
    greatest_ = scale * most;
    completePlanes();
    solidAngle_ = integrate();
}

void IesProfile::mirrorPlanes(float about) {
    const size_t count = vertical_.size();
    std::vector<std::pair<float, size_t>> planes;  // and the column that each has
    for (size_t h = 0; h < horizontal_.size(); ++h) {
        planes.emplace_back(horizontal_[h], h);
        if (horizontal_[h] != about) planes.emplace_back(2 * about - horizontal_[h], h);
    }
    std::sort(planes.begin(), planes.end());
    std::vector<float> values;
    horizontal_.clear();
    for (const auto& [angle, h] : planes) {
        horizontal_.push_back(angle);
        const auto column = values_.begin() + static_cast<std::ptrdiff_t>(h * count);
        values.insert(values.end(), column, column + static_cast<std::ptrdiff_t>(count));
    }
    values_ = std::move(values);
}

void IesProfile::completePlanes() {
    const bool polar = photometry_ == Photometry::C;
    if (horizontal_.size() == 1) {  // the same all around
        horizontal_ = polar ? std::vector{0.0F, 360.0F} : std::vector{-90.0F, 90.0F};
        values_.insert(values_.end(), values_.begin(), values_.end());
        return;
    }
    const float first = horizontal_.front(), last = horizontal_.back();
    if (!polar) {
        if (first == 0) mirrorPlanes(0);
        return;
    }
    if (first == 90 && last == 270) {
        mirrorPlanes(270);  // 90 to 450
        return;
    }
    if (first == 0 && last == 90) mirrorPlanes(90);
    if (first == 0 && (last == 90 || last == 180)) mirrorPlanes(180);
    // The plane at 360 degrees is that at 0.
    if (first == 0 && last > 180 && last < 360) {
        horizontal_.push_back(360);
        values_.insert(values_.end(), values_.begin(), values_.begin() + static_cast<std::ptrdiff_t>(vertical_.size()));
    }
    if (horizontal_.back() - horizontal_.front() != 360)
        throw Error(fmt::format("IES profile: horizontal angles from {} to {} degrees, expected 0 to 0, 90, 180 or 360",
                                first, last));
}

float IesProfile::at(float vertical, float horizontal) const {
    size_t v = 0, h = 0;
    float sv = 0, sh = 0;
    if (!find(vertical_, vertical, v, sv) || !find(horizontal_, horizontal, h, sh)) return 0;
    const auto column = [&](size_t plane) {
        const float* const values = &values_[plane * vertical_.size()];
        return sv > 0 ? (1 - sv) * values[v] + sv * values[v + 1] : values[v];
    };
    return sh > 0 ? (1 - sh) * column(h) + sh * column(h + 1) : column(h);
}

float IesProfile::relative(Vec3 d) const {
    switch (photometry_) {
        case Photometry::C: {
            float around = std::atan2(d.y, d.x) / kDegree;
            while (around < horizontal_.front()) around += 360;
            return at(std::atan2(std::hypot(d.x, d.y), -d.z) / kDegree, around);
        }
        // Of these the horizontal angle runs clockwise, to +X.
        case Photometry::B:
            return at(std::atan2(d.y, -d.z) / kDegree, std::asin(std::clamp(d.x, -1.0F, 1.0F)) / kDegree);
        case Photometry::A:
            return at(std::asin(std::clamp(d.y, -1.0F, 1.0F)) / kDegree, std::atan2(d.x, -d.z) / kDegree);
    }
    return 0;
}

// Over cells of the angles measured, each by its own solid angle: however narrow the beam.
float IesProfile::integrate() const {
    constexpr int kParts = 4;
    const bool byVertical = photometry_ != Photometry::B;  // along which circles of latitude shrink
    const auto latitude = [&](float angle) {               // its integral of the circles' length
        const double a = static_cast<double>(angle * kDegree);
        return photometry_ == Photometry::C ? -std::cos(a) : std::sin(a);
    };
    double sum = 0;
    for (size_t h = 0; h + 1 < horizontal_.size(); ++h)
        for (size_t v = 0; v + 1 < vertical_.size(); ++v)
            for (int part = 0; part < kParts * kParts; ++part) {
                const auto cut = [](const std::vector<float>& a, size_t i, int p) {
                    return a[i] + (a[i + 1] - a[i]) * static_cast<float>(p) / kParts;
                };
                const int pv = part % kParts, ph = part / kParts;
                const float v0 = cut(vertical_, v, pv), v1 = cut(vertical_, v, pv + 1);
                const float h0 = cut(horizontal_, h, ph), h1 = cut(horizontal_, h, ph + 1);
                const double across = byVertical ? latitude(v1) - latitude(v0) : latitude(h1) - latitude(h0);
                const float along = byVertical ? h1 - h0 : v1 - v0;
                sum += static_cast<double>(at(0.5F * (v0 + v1), 0.5F * (h0 + h1)) * along * kDegree) * across;
            }
    return static_cast<float>(sum);
}

}  // namespace lsde
