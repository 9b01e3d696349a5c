#include "store/file.h"

#include <doctest/doctest.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>

#include "store/fixture.h"

namespace fs = std::filesystem;
using namespace lsde;
using test::contentOf;
using test::errorOf;
using test::inChild;
using test::TemporaryFolder;

namespace {

using Names = std::vector<std::string>;

// What is written from here on may make no file longer than that; as in the program, that is an error of the write.
void limitFileSize(rlim_t bytes) {
    const rlimit limit{bytes, bytes};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    ::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace

TEST_CASE("a file is read whole") {
    const TemporaryFolder folder;
    const std::string content("a\0b\r\n\xff", 6);
    test::put(folder / "file", content);
    CHECK(readFile(folder / "file", 6) == content);
    test::put(folder / "empty", "");
    CHECK(readFile(folder / "empty", 0).empty());
}

TEST_CASE("what cannot be read is refused by name and reason") {
    const TemporaryFolder folder;
    test::put(folder / "file", "12345");
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    const auto refusal = [&](const std::string& name) { return errorOf([&] { readFile(folder / name, 4); }); };
    const std::string prefix = folder.path().string() + "/";
    CHECK(refusal("file") == prefix + "file: 5 bytes, expected at most 4");
    CHECK(refusal("none") == prefix + "none: cannot be opened: No such file or directory");
    CHECK(refusal("") == prefix + ": is a folder, expected a file");
    CHECK(refusal("pipe") == prefix + "pipe: is a pipe, expected a file");
}

TEST_CASE("a written file has its content and leaves no temporary behind") {
    const TemporaryFolder folder;
    writeFileAtomically(folder / "file", "old");
    CHECK(contentOf(folder / "file") == "old");
    writeFileAtomically(folder / "file", "new");
    CHECK(contentOf(folder / "file") == "new");
    CHECK(folder.names() == Names{"file"});
}

TEST_CASE("writing within a file does not move its end") {
    const TemporaryFolder folder;
    AtomicFile file(folder / "file");
    const auto bytes = [](std::string_view text) { return std::as_bytes(std::span(text)); };
    file.write(bytes("abcdef"));
    file.writeAt(1, bytes("BC"));
    file.write(bytes("g"));
    CHECK(file.size() == 7);
    file.commit();
    CHECK(contentOf(folder / "file") == "aBCdefg");
}

TEST_CASE("an exception during writing leaves the old file and no temporary") {
    const TemporaryFolder folder;
    test::put(folder / "file", "old");
    CHECK_THROWS_AS(
        [&] {
            AtomicFile file(folder / "file");
            file.write(std::as_bytes(std::span("half")));
            CHECK(folder.names().size() == 2);
            throw Error("interrupted");
        }(),
        Error);
    CHECK(contentOf(folder / "file") == "old");
    CHECK(folder.names() == Names{"file"});
}

TEST_CASE("a write beyond the space there is leaves the old file and no temporary") {
    const TemporaryFolder folder;
    test::put(folder / "file", "old");
    const auto result = inChild([&] {
        limitFileSize(8192);
        writeFileAtomically(folder / "file", std::string(1 << 20, 'x'));
    });
    CHECK(result.exitedWith(3));
    CHECK(result.standardError == (folder / "file").string() + ": cannot be written: File too large");
    CHECK(contentOf(folder / "file") == "old");
    CHECK(folder.names() == Names{"file"});
}

TEST_CASE("the temporary of a killed writer is reused, that of a running one is not") {
    const TemporaryFolder folder;
    const auto result = inChild([&] {
        AtomicFile file(folder / "file");
        file.write(std::as_bytes(std::span("left behind by a process that was killed")));
        ::raise(SIGKILL);
    });
    CHECK(result.killedBy(SIGKILL));
    const Names left = folder.names();
    REQUIRE(left.size() == 1);
    AtomicFile first(folder / "file");
    CHECK(folder.names() == left);
    AtomicFile second(folder / "file");
    CHECK(folder.names().size() == 2);
    first.write(std::as_bytes(std::span("1", 1)));
    second.write(std::as_bytes(std::span("2", 1)));
    second.commit();
    first.commit();
    CHECK(contentOf(folder / "file") == "1");
    CHECK(folder.names() == Names{"file"});
}

TEST_CASE("a link planted under the temporary's name is not followed") {
    const TemporaryFolder folder;
    test::put(folder / "precious", "keep");
    AtomicFile probe(folder / "file");
    const std::string temporary = folder.names().front();
    probe.commit();
    for (const bool symbolic : {true, false}) {
        if (symbolic)
            fs::create_symlink(folder / "precious", folder / temporary);
        else
            fs::create_hard_link(folder / "precious", folder / temporary);
        writeFileAtomically(folder / "file", "new");
        CHECK(contentOf(folder / "precious") == "keep");
        CHECK(contentOf(folder / "file") == "new");
        fs::remove(folder / temporary);
    }
}

TEST_CASE("the file that a symbolic link names is replaced, the link stays") {
    const TemporaryFolder folder;
    test::put(folder / "file", "old");
    fs::create_symlink("file", folder / "link");
    writeFileAtomically(folder / "link", "new");
    CHECK(fs::is_symlink(folder / "link"));
    CHECK(contentOf(folder / "file") == "new");
}

TEST_CASE("a name as long as the file system allows can be written") {
    const TemporaryFolder folder;
    const std::string name(255, 'n');
    writeFileAtomically(folder / name, "content");
    CHECK(folder.names() == Names{name});
}

TEST_CASE("an output is refused before the work if it exists or has no folder") {
    const TemporaryFolder folder;
    test::put(folder / "file", "old");
    const std::string prefix = folder.path().string() + "/";
    const auto refusal = [&](const std::string& name, bool force) {
        return errorOf([&] { checkOutput(folder / name, force); });
    };
    CHECK(refusal("file", false) == prefix + "file: exists, and is overwritten only with --force");
    CHECK(refusal("file", true).empty());
    CHECK(refusal("new", false).empty());
    CHECK(refusal("none/new", true) == prefix + "none/new: folder " + prefix + "none does not exist");
    CHECK(refusal("file/new", true) == prefix + "file/new: cannot be written: Not a directory");
    CHECK(refusal(std::string(300, 'n'), false).ends_with(": cannot be written: File name too long"));
    CHECK(folder.names() == Names{"file"});
}

TEST_CASE("what is no regular file is never replaced by an output") {
    const TemporaryFolder folder;
    REQUIRE(::mkfifo((folder / "pipe").c_str(), 0600) == 0);
    fs::create_directory(folder / "folder");
    const std::string expected = ", expected a new name or a regular file, which is replaced as a whole";
    for (const auto& [name, kind] :
         {std::pair{"pipe", "is a pipe"}, std::pair{"folder", "is a folder"}, std::pair{"folder/", "is a folder"}}) {
        const fs::path path = folder / name;
        const std::string message = fmt::format("{}: {}{}", path.string(), kind, expected);
        CHECK(errorOf([&] { checkOutput(path, true); }) == message);
        CHECK(errorOf([&] { writeFileAtomically(path, "content"); }) == message);
    }
    // Only asked, never written: run as root, a failing test would take the machine's device away.
    CHECK(errorOf([&] { checkOutput("/dev/null", true); }) == "/dev/null: is a device" + expected);
    CHECK(fs::is_fifo(folder / "pipe"));
}

TEST_CASE("a folder without the right to write is refused before the work") {
    const TemporaryFolder folder;
    fs::permissions(folder.path(), fs::perms(0555));
    const auto result = inChild([&] {
        constexpr uid_t kNobody = 65534;
        if (::geteuid() == 0 && ::setuid(kNobody) != 0) throw Error("setuid");
        checkOutput(folder / "new", false);
    });
    fs::permissions(folder.path(), fs::perms::owner_all);
    CHECK(result.exitedWith(3));
    CHECK(result.standardError ==
          fmt::format("{}: folder {} is not writable", (folder / "new").string(), folder.path().string()));
}

TEST_CASE("a mapped file shows the file's bytes") {
    const TemporaryFolder folder;
    test::put(folder / "file", "content");
    test::put(folder / "empty", "");
    MappedFile mapped(folder / "file");
    MappedFile other(folder / "empty");
    CHECK(other.bytes().empty());
    other = std::move(mapped);
    CHECK(std::string(reinterpret_cast<const char*>(other.bytes().data()), other.bytes().size()) == "content");
    CHECK(other.path() == folder / "file");
    CHECK(errorOf([&] { MappedFile(folder / "none"); }).ends_with("cannot be opened: No such file or directory"));
}

TEST_CASE("a file cut while mapped ends the process in one line") {
    const TemporaryFolder folder;
    test::put(folder / "file", std::string(3 * 4096, 'x'));
    test::put(folder / "other", "y");
    const auto result = inChild([&] {
        guardMappedFiles();
        const MappedFile other(folder / "other");
        const MappedFile mapped(folder / "file");
        fs::resize_file(folder / "file", 4096);
        const volatile auto byte = mapped.bytes()[2 * 4096];
        static_cast<void>(byte);
    });
    CHECK(result.exitedWith(1));
    CHECK(result.standardError == "error: " + (folder / "file").string() + ": was cut while in use\n");
}

TEST_CASE("a bus error elsewhere keeps its default") {
    const auto result = inChild([] {
        ::signal(SIGBUS, SIG_DFL);
        const rlimit noCore{0, 0};
        ::setrlimit(RLIMIT_CORE, &noCore);
        guardMappedFiles();
        ::raise(SIGBUS);
    });
    CHECK(result.killedBy(SIGBUS));
    CHECK(result.standardError.empty());
}
