#include "photon/map_file.h"

#include <fmt/format.h>

#include <atomic>
#include <numeric>

#include "base/error.h"
#include "photon/map_header.h"
#include "store/container.h"

namespace lsde {

namespace {

constexpr ContainerKind kKind{"photons", kMapVersion};

struct SectionNames {
    explicit SectionNames(PhotonClass c)
        : blocks(std::string(name(c)) + ".blocks"),
          nodes(std::string(name(c)) + ".nodes"),
          payload(std::string(name(c)) + ".payload") {}
    std::string blocks, nodes, payload;
};

// Checks one class of a file against what its header says, and says which record of which section is wrong.
class ClassChecker {
  public:
    ClassChecker(const std::string& file, PhotonClass photonClass, const PhotonTreeView& tree, size_t lights)
        : file_(file), names_(photonClass), tree_(tree), shape_(tree.count), lights_(lights) {}

    void checkSizes() const {
        checkSize(names_.blocks, tree_.blocks.size(), shape_.blocks);
        checkSize(names_.nodes, tree_.nodes.size(), shape_.nodes);
        checkSize(names_.payload, tree_.payload.size(), tree_.count);
    }

    void checkContent(ThreadPool& pool) const {
        checkEach(pool, tree_.blocks.size(), [&](size_t i) { return blockProblem(i); });
        checkEach(pool, tree_.payload.size(), [&](size_t i) { return payloadProblem(i); });
        checkNodes(pool);
        if (tree_.count == 0) return;
        const Bounds bounds = boundsOf(tree_.nodes.front());
        if (bounds.lo != tree_.bounds.lo || bounds.hi != tree_.bounds.hi)
            fail(names_.nodes, "bounds differ from those in the header");
    }

  private:
    [[noreturn]] void fail(std::string_view section, std::string_view what) const {
        throw Error(fmt::format("{}: section \"{}\": {}", file_, section, what));
    }

    void checkSize(std::string_view section, uint64_t size, uint64_t expected) const {
        if (size != expected)
            fail(section, fmt::format("{} records, expected {} for {} photons", size, expected, tree_.count));
    }

    // Throws what problem(i) says ("SECTION: WHAT"; empty: none) for the lowest i that has one, whatever the threads.
    template <typename Problem>
    void checkEach(ThreadPool& pool, size_t count, const Problem& problem) const {
        std::atomic<size_t> first = count;
        pool.forRange(count, kTreeGrain, [&](size_t begin, size_t end) {
            for (size_t i = begin; i < end && i < first; ++i) {
                if (problem(i).empty()) continue;
                size_t lowest = first;
                while (i < lowest && !first.compare_exchange_weak(lowest, i)) {
                }
            }
        });
        if (first < count) throw Error(fmt::format("{}: section {}", file_, problem(first)));
    }

    std::string blockProblem(size_t b) const {
        const PhotonBlock& block = tree_.blocks[b];
        for (size_t i = 0; i < kBlockSize; ++i) {
            const Vec3 p(block.x[i], block.y[i], block.z[i]);
            const uint64_t record = b * kBlockSize + i;
            if (record < tree_.count ? validPosition(p) : p == Vec3(kAbsentPhoton)) continue;
            return fmt::format("\"{}\": record {}: position ({}, {}, {}), expected {}", names_.blocks, record, p.x, p.y,
                               p.z, record < tree_.count ? "finite coordinates" : "an absent photon's");
        }
        return {};
    }

    std::string payloadProblem(size_t i) const {
        const PhotonPayload& p = tree_.payload[i];
        const auto problem = [&](std::string_view what) {
            return fmt::format("\"{}\": record {}: {}", names_.payload, i, what);
        };
        if (p.light >= lights_) return problem(fmt::format("light {}, expected one of {}", p.light, lights_));
        if (!PathCode(p.path).valid()) return problem(fmt::format("path {:016x}, expected events of a path", p.path));
        if ((p.flags & ~kAllPhotonFlags) != 0)
            return problem(fmt::format("flags {:x}, expected none but {:x}", int{p.flags}, kAllPhotonFlags));
        return {};
    }

    void checkNodes(ThreadPool& pool) const {
        for (size_t level = 0; level < static_cast<size_t>(shape_.levels); ++level)
            checkEach(pool, shape_.size[level], [&](size_t i) -> std::string {
                const size_t node = shape_.first[level] + i;
                const KdNode expected =
                    level == 0
                        ? nodeOver(childrenOf(i, tree_.blocks))
                        : nodeOver(childrenOf(i, tree_.nodes.subspan(shape_.first[level - 1], shape_.size[level - 1])));
                if (expected == tree_.nodes[node]) return {};
                return fmt::format("\"{}\": record {}: a box does not fit its photons", names_.nodes, node);
            });
    }

    template <typename Child>
    static std::span<const Child> childrenOf(size_t node, std::span<const Child> level) {
        const size_t from = node * kNodeWidth;
        return level.subspan(from, std::min<size_t>(kNodeWidth, level.size() - from));
    }

    const std::string& file_;
    SectionNames names_;
    PhotonTreeView tree_;
    KdShape shape_;
    size_t lights_;
};

MapDescription readHeader(const ContainerReader& container) {
    const auto text = container.section<char>("header");
    try {
        return fromJson({text.data(), text.size()});
    } catch (const Error& e) {
        throw Error(fmt::format("{}: section \"header\": {}", container.path().string(), e.what()));
    }
}

// In the file's order.
std::vector<std::string> sectionsOf(const MapDescription& map) {
    std::vector<std::string> out = {"header"};
    for (size_t c = 0; c < kPhotonClasses; ++c) {
        const SectionNames names(static_cast<PhotonClass>(c));
        if (map.classes[c].stored) out.insert(out.end(), {names.nodes, names.blocks, names.payload});
    }
    return out;
}

}  // namespace

std::string_view name(PhotonClass c) {
    constexpr std::array<std::string_view, kPhotonClasses> kNames = {"caustic", "indirect", "direct"};
    return kNames[static_cast<size_t>(c)];
}

uint64_t MapHeader::emittedPaths() const {
    return std::accumulate(ranges.begin(), ranges.end(), uint64_t{0},
                           [](uint64_t sum, const IndexRange& r) { return sum + (r.end - r.begin); });
}

struct PhotonMap::Mapping {
    ContainerReader container;
};

void PhotonMap::expectLookups() const {
    if (mapping_) mapping_->container.expectLookups();
}

PhotonTreeView PhotonMap::photons(PhotonClass c) const { return views_[static_cast<size_t>(c)]; }
bool PhotonMap::stores(PhotonClass c) const { return stored_[static_cast<size_t>(c)]; }

void PhotonMap::setTree(PhotonClass c, PhotonTree tree) {
    const auto i = static_cast<size_t>(c);
    trees_[i] = std::make_shared<const PhotonTree>(std::move(tree));
    views_[i] = view(*trees_[i]);
    stored_[i] = true;
}

void writePhotonMap(const std::filesystem::path& path, const PhotonMap& map, RunContext& run) {
    MapDescription description{map.header, {}};
    for (size_t c = 0; c < kPhotonClasses; ++c) {
        const PhotonTreeView tree = map.photons(static_cast<PhotonClass>(c));
        description.classes[c] = {map.stores(static_cast<PhotonClass>(c)), tree.count, tree.bounds};
    }
    const std::string header = toJson(description);
    ContainerWriter writer(path, kKind);
    writer.section("header", std::span<const char>(header));
    for (size_t c = 0; c < kPhotonClasses; ++c) {
        if (!description.classes[c].stored) continue;
        run.checkInterrupt();
        const SectionNames names(static_cast<PhotonClass>(c));
        const PhotonTreeView tree = map.photons(static_cast<PhotonClass>(c));
        writer.section(names.nodes, tree.nodes);
        writer.section(names.blocks, tree.blocks);
        writer.section(names.payload, tree.payload);
    }
    writer.commit();
}

PhotonMap readPhotonMap(const std::filesystem::path& path, RunContext& run, bool verifyAll) {
    auto mapping = std::make_shared<PhotonMap::Mapping>(PhotonMap::Mapping{ContainerReader(path, kKind)});
    const ContainerReader& container = mapping->container;
    if (verifyAll) container.verify([&](size_t n, const std::function<void(size_t)>& f) { run.pool.forEach(n, f); });
    const std::string file = path.string();
    MapDescription description = readHeader(container);
    if (container.sectionNames() != sectionsOf(description))
        throw Error(fmt::format("{}: its sections are not those that its header names", file));
    PhotonMap map;
    map.header = std::move(description.header);
    for (size_t i = 0; i < kPhotonClasses; ++i) {
        if (!description.classes[i].stored) continue;
        const auto photonClass = static_cast<PhotonClass>(i);
        const SectionNames names(photonClass);
        const PhotonTreeView tree = {
            description.classes[i].count, description.classes[i].bounds, container.section<PhotonBlock>(names.blocks),
            container.section<KdNode>(names.nodes), container.section<PhotonPayload>(names.payload)};
        const ClassChecker checker(file, photonClass, tree, map.header.lights.size());
        checker.checkSizes();
        checker.checkContent(run.pool);
        map.views_[i] = tree;
        map.stored_[i] = true;
    }
    map.mapping_ = std::move(mapping);
    return map;
}

}  // namespace lsde
