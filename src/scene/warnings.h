// Warnings of one kind, however often they come up, make one line with their count.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lsde {

class Warnings {
  public:
    // `kind` is what is wrong, in words that fit any object; `where` is kept from the first call only.
    void add(const std::string& kind, const std::string& where, uint64_t count = 1);
    // "FILE: WHERE: KIND", with " (N in all)" after it if it came up more than once; in order of first appearance.
    std::vector<std::string> lines(const std::string& file) const;

  private:
    struct Entry {
        std::string kind, where;
        uint64_t count = 0;
    };
    std::vector<Entry> entries_;
    std::map<std::string, size_t> index_;
};

}  // namespace lsde
