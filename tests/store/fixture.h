// Folders and child processes for tests.
#pragma once

#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "base/error.h"

namespace lsde::test {

// A new folder, removed with all in it at the end of the test.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string name = (std::filesystem::temp_directory_path() / "lsde-test-XXXXXX").string();
        if (::mkdtemp(name.data()) == nullptr) throw Error(name + ": cannot be made");
        path_ = name;
    }
    ~TemporaryFolder() { std::filesystem::remove_all(path_); }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;

    std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
    const std::filesystem::path& path() const { return path_; }
    // Names of all files, hidden ones too, sorted.
    std::vector<std::string> names() const {
        std::vector<std::string> out;
        for (const auto& entry : std::filesystem::directory_iterator(path_)) out.push_back(entry.path().filename());
        std::sort(out.begin(), out.end());
        return out;
    }

  private:
    std::filesystem::path path_;
};

inline std::string contentOf(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
}

inline void put(const std::filesystem::path& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
}

// The message of the Error that f throws; empty if it throws none.
inline std::string errorOf(const std::function<void()>& f) {
    try {
        f();
    } catch (const Error& e) {
        return e.what();
    }
    return {};
}

struct ChildResult {
    int status = 0;  // as of waitpid
    std::string standardError;
    bool exitedWith(int code) const { return WIFEXITED(status) && WEXITSTATUS(status) == code; }
    bool killedBy(int signal) const { return WIFSIGNALED(status) && WTERMSIG(status) == signal; }
};

// Runs f in a child process, for what ends a process or changes its limits. The child exits with 0, or with 3 and the
// message on standard error if f throws.
inline ChildResult inChild(const std::function<void()>& f) {
    std::array<int, 2> pipe{};
    if (::pipe(pipe.data()) != 0) throw Error("pipe");
    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(pipe[1], STDERR_FILENO);
        int code = 0;
        try {
            f();
        } catch (const std::exception& e) {
            const std::string message = e.what();
            code = ::write(STDERR_FILENO, message.data(), message.size()) > 0 ? 3 : 4;
        }
        ::_exit(code);
    }
    ::close(pipe[1]);
    ChildResult result;
    std::array<char, 4096> buffer{};
    for (ssize_t n = 0; (n = ::read(pipe[0], buffer.data(), buffer.size())) > 0;)
        result.standardError.append(buffer.data(), static_cast<size_t>(n));
    ::close(pipe[0]);
    ::waitpid(child, &result.status, 0);
    return result;
}

}  // namespace lsde::test
