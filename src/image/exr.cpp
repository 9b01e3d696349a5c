#include "image/exr.h"

#include <ImfBoxAttribute.h>
#include <ImfChannelList.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfCompression.h>
#include <ImfDoubleAttribute.h>
#include <ImfFloatAttribute.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfIntAttribute.h>
#include <ImfMatrixAttribute.h>
#include <ImfOutputFile.h>
#include <ImfPartType.h>
#include <ImfStandardAttributes.h>
#include <ImfStdIO.h>
#include <ImfStringAttribute.h>
#include <ImfThreading.h>
#include <ImfVecAttribute.h>
#include <ImfVersion.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <span>

#include "base/error.h"
#include "store/file.h"

namespace lsde {

namespace {

// Deflate packs at most 1032 bytes into one, the other compressions less (PIZ: 402, measured); a value has at least 2.
constexpr int64_t kMaxValuesPerByte = 516;

// ---------------------------------------------------------------------------------------------------------- writing

Imf::Header makeHeader(const ImageFile& image, const ExrMetadata& metadata) {
    Imf::Header header(image.width, image.height);
    header.compression() = Imf::ZIP_COMPRESSION;
    // Of noise little is left out at any: 1.4% more bytes than at 4, in a fifth less time.
    header.zipCompressionLevel() = 1;
    Imf::addChromaticities(header, Imf::Chromaticities());  // the default is Rec. 709 with D65
    if (metadata.whiteLuminance) Imf::addWhiteLuminance(header, *metadata.whiteLuminance);
    if (metadata.worldToCamera) {
        Imath::M44f matrix;
        std::memcpy(matrix.x, metadata.worldToCamera->data(), sizeof matrix.x);
        Imf::addWorldToCamera(header, matrix);
    }
    for (const auto& [name, text] : metadata.text) header.insert(name, Imf::StringAttribute(text));
    for (const auto& [name, number] : metadata.numbers) header.insert(name, Imf::FloatAttribute(number));
    for (const auto& [name, values] : image.channels) {
        LSDE_ASSERT(values.size() == static_cast<size_t>(image.width) * static_cast<size_t>(image.height));
        header.channels().insert(name, Imf::Channel(Imf::FLOAT));
    }
    return header;
}

// Slices over the channels' values, to be read or filled; these must outlive the frame buffer.
Imf::FrameBuffer frameBuffer(const ImageFile& image, const Imath::Box2i& window) {
    Imf::FrameBuffer buffer;
    for (const auto& [name, values] : image.channels)
        buffer.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), window));
    return buffer;
}

// In memory, because OpenEXR writes the table of its chunks in a destructor, where an error is lost.
std::string encodeExr(const ImageFile& image, const ExrMetadata& metadata, int threads) {
    const int helpers = threads > 1 ? threads : 0;  // of OpenEXR's own, shared by all files
    if (helpers > Imf::globalThreadCount()) Imf::setGlobalThreadCount(helpers);
    const Imf::Header header = makeHeader(image, metadata);
    Imf::StdOSStream stream;
    {
        Imf::OutputFile file(stream, header, helpers);
        file.setFrameBuffer(frameBuffer(image, header.dataWindow()));
        file.writePixels(image.height);
    }
    return stream.str();
}

// ---------------------------------------------------------------------------------------------------------- reading

class MemoryStream : public Imf::IStream {
  public:
    explicit MemoryStream(std::span<const std::byte> bytes) : IStream("(EXR)"), bytes_(bytes) {}

    bool read(char target[], int count) override {
        const auto wanted = static_cast<uint64_t>(count);
        if (at_ > bytes_.size() || wanted > bytes_.size() - at_) throw Error("truncated");
        std::memcpy(target, bytes_.data() + at_, wanted);
        at_ += wanted;
        return at_ < bytes_.size();
    }
    uint64_t tellg() override { return at_; }
    void seekg(uint64_t position) override { at_ = position; }

  private:
    std::span<const std::byte> bytes_;
    uint64_t at_ = 0;
};

// Magic number and version; the flags of the latter tell multi-part and deep files.
int readVersion(MemoryStream& stream, size_t bytes) {
    std::array<char, 4> magic{};
    if (bytes < magic.size()) throw Error(fmt::format("is not an OpenEXR file: {} bytes", bytes));
    stream.read(magic.data(), magic.size());
    if (!Imf::isImfMagic(magic.data())) throw Error("is not an OpenEXR file");
    int version = 0;
    stream.read(reinterpret_cast<char*>(&version), sizeof version);
    if (Imf::isMultiPart(version)) throw Error("is a multi-part OpenEXR file, expected a single part");
    if (Imf::isNonImage(version)) throw Error("is a deep OpenEXR file, expected flat pixels");
    return version;
}

// OpenEXR allocates by the size that an attribute records, before it reads that much.
void checkAttributeSizes(std::span<const std::byte> attributes) {
    const char* at = reinterpret_cast<const char*>(attributes.data());
    const char* end = at + attributes.size();
    const auto nextString = [&] {
        const char* terminator = std::find(at, end, '\0');
        if (terminator == end) throw Error("truncated within its header");
        const std::string_view text(at, static_cast<size_t>(terminator - at));
        at = terminator + 1;
        return text;
    };
    for (std::string_view name = nextString(); !name.empty(); name = nextString()) {
        nextString();  // the type
        uint32_t size = 0;
        if (end - at < static_cast<ptrdiff_t>(sizeof size)) throw Error("truncated within its header");
        std::memcpy(&size, at, sizeof size);
        at += sizeof size;
        if (end - at < static_cast<ptrdiff_t>(size))
            throw Error(fmt::format("attribute \"{}\": {} bytes, but the file ends after {}", name, size, end - at));
        at += size;
    }
}

Imf::Header readHeader(std::span<const std::byte> bytes) {
    MemoryStream stream(bytes);
    int version = readVersion(stream, bytes.size());
    checkAttributeSizes(bytes.subspan(stream.tellg()));
    Imf::Header header;
    header.readFrom(stream, version);
    return header;
}

std::string text(const Imath::Box2i& b) { return fmt::format("{} {} {} {}", b.min.x, b.min.y, b.max.x, b.max.y); }

// Throws Error for what readExr does not take, before anything is allocated by the file's word.
void checkHeader(const Imf::Header& header, int64_t maxPixels, uint64_t fileBytes) {
    if (header.hasType() && Imf::isDeepData(header.type())) throw Error("is a deep OpenEXR file, expected flat pixels");
    // The decoder of OpenEXR 3.1.5 takes memory by a chunk's word, without limit and without a look at the result.
    if (header.compression() == Imf::DWAA_COMPRESSION || header.compression() == Imf::DWAB_COMPRESSION)
        throw Error("is compressed by DWA, which is lossy, expected any other compression");
    const Imath::Box2i& window = header.dataWindow();
    if (window != header.displayWindow())
        throw Error(
            fmt::format("data window {}, expected the display window, {}", text(window), text(header.displayWindow())));
    const int64_t width = int64_t{window.max.x} - window.min.x + 1;
    const int64_t height = int64_t{window.max.y} - window.min.y + 1;
    if (width < 1 || height < 1) throw Error(fmt::format("data window {} is empty", text(window)));
    if (width > maxPixels || height > maxPixels / width)
        throw Error(fmt::format("{}x{} pixels, expected at most {}", width, height, maxPixels));
    int64_t channels = 0;
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c, ++channels)
        if (c.channel().xSampling != 1 || c.channel().ySampling != 1)
            throw Error(fmt::format("channel \"{}\" is sub-sampled {}x{}, expected 1x1", c.name(),
                                    c.channel().xSampling, c.channel().ySampling));
    if (channels == 0) throw Error("has no channels");
    if (channels * width * height / kMaxValuesPerByte > static_cast<int64_t>(fileBytes))
        throw Error(
            fmt::format("{}x{} pixels with {} channels cannot be in {} bytes", width, height, channels, fileBytes));
}

// The values of an attribute with numbers, or its type if it is no list of numbers.
std::string text(const Imf::Attribute& attribute) {
    if (const auto* a = dynamic_cast<const Imf::StringAttribute*>(&attribute)) return a->value();
    if (const auto* a = dynamic_cast<const Imf::FloatAttribute*>(&attribute)) return fmt::format("{}", a->value());
    if (const auto* a = dynamic_cast<const Imf::DoubleAttribute*>(&attribute)) return fmt::format("{}", a->value());
    if (const auto* a = dynamic_cast<const Imf::IntAttribute*>(&attribute)) return fmt::format("{}", a->value());
    if (const auto* a = dynamic_cast<const Imf::Box2iAttribute*>(&attribute)) return text(a->value());
    if (const auto* a = dynamic_cast<const Imf::V2fAttribute*>(&attribute))
        return fmt::format("{} {}", a->value().x, a->value().y);
    if (const auto* a = dynamic_cast<const Imf::M44fAttribute*>(&attribute))
        return fmt::format("{}", fmt::join(std::span(&a->value().x[0][0], 16), " "));
    if (const auto* a = dynamic_cast<const Imf::ChromaticitiesAttribute*>(&attribute)) {
        const Imf::Chromaticities& c = a->value();
        return fmt::format("{} {} {} {} {} {} {} {}", c.red.x, c.red.y, c.green.x, c.green.y, c.blue.x, c.blue.y,
                           c.white.x, c.white.y);
    }
    return fmt::format("({})", attribute.typeName());
}

ImageFile decodeExr(std::span<const std::byte> bytes, int64_t maxPixels) {
    const Imf::Header header = readHeader(bytes);
    checkHeader(header, maxPixels, bytes.size());
    MemoryStream stream(bytes);
    Imf::InputFile file(stream);
    if (!file.isComplete()) throw Error("truncated: parts of the picture are missing");

    const Imath::Box2i& window = header.dataWindow();
    ImageFile image;
    image.width = window.max.x - window.min.x + 1;
    image.height = window.max.y - window.min.y + 1;
    for (auto a = header.begin(); a != header.end(); ++a) image.attributes[a.name()] = text(a.attribute());
    const size_t pixels = static_cast<size_t>(image.width) * static_cast<size_t>(image.height);
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) image.channels[c.name()].resize(pixels);
    file.setFrameBuffer(frameBuffer(image, window));
    file.readPixels(window.min.y, window.max.y);
    return image;
}

}  // namespace

void writeExr(const std::filesystem::path& path, const ImageFile& image, const ExrMetadata& metadata, int threads) {
    std::string bytes;
    try {
        bytes = encodeExr(image, metadata, threads);
    } catch (const std::exception& e) {
        throw Error(fmt::format("{}: cannot be encoded: {}", path.string(), e.what()));
    }
    writeFileAtomically(path, bytes);
}

ImageFile readExr(const std::filesystem::path& path, int64_t maxPixels) {
    const MappedFile file(path);
    try {
        return decodeExr(file.bytes(), maxPixels);
    } catch (const Error& e) {
        throw Error(fmt::format("{}: {}", path.string(), e.what()));
    } catch (const std::exception& e) {
        throw Error(fmt::format("{}: damaged: {}", path.string(), e.what()));
    }
}

}  // namespace lsde
