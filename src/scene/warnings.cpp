#include "scene/warnings.h"

#include <fmt/format.h>

namespace lsde {

void Warnings::add(const std::string& kind, const std::string& where, uint64_t count) {
    const auto [at, added] = index_.try_emplace(kind, entries_.size());
    if (added) entries_.push_back({kind, where, 0});
    entries_[at->second].count += count;
}

std::vector<std::string> Warnings::lines(const std::string& file) const {
    std::vector<std::string> lines;
    for (const Entry& e : entries_) {
        std::string line = file + ": " + (e.where.empty() ? "" : e.where + ": ") + e.kind;
        if (e.count > 1) line += fmt::format(" ({} in all)", e.count);
        lines.push_back(std::move(line));
    }
    return lines;
}

}  // namespace lsde
