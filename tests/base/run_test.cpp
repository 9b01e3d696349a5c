#include "base/run.h"

#include <doctest/doctest.h>

#include <csignal>
#include <string>
#include <vector>

#include "base/error.h"

using namespace lsde;

TEST_CASE("log lines go to whoever listens, warnings are kept as well") {
    RunContext run(1);
    run.info("nobody listens");
    std::vector<std::pair<LogLevel, std::string>> lines;
    run.onLog = [&](LogLevel level, const std::string& line) { lines.emplace_back(level, line); };
    run.debug("a");
    run.info("b");
    run.warn("c");
    CHECK(lines == std::vector<std::pair<LogLevel, std::string>>{
                       {LogLevel::Debug, "a"}, {LogLevel::Info, "b"}, {LogLevel::Warning, "c"}});
    CHECK(run.warnings() == std::vector<std::string>{"c"});
}

TEST_CASE("progress goes to whoever listens") {
    RunContext run(1);
    run.progress("emit", 0.25);
    Progress last;
    run.onProgress = [&](const Progress& p) { last = p; };
    run.progress("render", 0.5);
    CHECK(last.phase == "render");
    CHECK(last.done == 0.5);
}

TEST_CASE("an interrupted run throws at its next look, and names the signal") {
    RunContext run(1);
    CHECK(!run.interrupted());
    CHECK_NOTHROW(run.checkInterrupt());
    run.interruptSignal = SIGTERM;
    CHECK(run.interrupted());
    try {
        run.checkInterrupt();
        FAIL("not thrown");
    } catch (const Interrupted& e) {
        CHECK(e.signal == SIGTERM);
    }
}

TEST_CASE("an interrupt set by another thread of the loop stops the loop") {
    RunContext run(2);
    std::atomic<int> done{0};
    CHECK_THROWS_AS(run.pool.forEach(10000,
                                     [&](size_t i) {
                                         run.checkInterrupt();
                                         if (i == 10) run.interruptSignal = SIGINT;
                                         ++done;
                                     }),
                    Interrupted);
    CHECK(done < 10000);
}

TEST_CASE("phases are kept in the order in which they end, with times that are not negative") {
    RunContext run(1, 42);
    CHECK(run.seed == 42);
    {
        const PhaseTimer outer(run, "outer");
        const PhaseTimer inner(run, "inner");
    }
    REQUIRE(run.phases.size() == 2);
    CHECK(run.phases[0].name == "inner");
    CHECK(run.phases[1].name == "outer");
    for (const PhaseTime& phase : run.phases) {
        CHECK(phase.wall >= 0);
        CHECK(phase.cpu >= 0);
    }
    CHECK(run.phases[1].wall >= run.phases[0].wall);
}

TEST_CASE("clocks do not run backwards, and a process has some memory") {
    const double wall = wallSeconds(), cpu = cpuSeconds();
    CHECK(wall >= 0);
    CHECK(cpu > 0);
    CHECK(wallSeconds() >= wall);
    CHECK(cpuSeconds() >= cpu);
    CHECK(peakMemoryBytes() > 100000);
}
