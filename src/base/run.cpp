#include "base/run.h"

#include <sys/resource.h>

#include <chrono>
#include <ctime>
#include <utility>

#include "base/error.h"

namespace lsde {

namespace {

const auto kStart = std::chrono::steady_clock::now();

}  // namespace

double wallSeconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now() - kStart).count(); }

double cpuSeconds() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

uint64_t peakMemoryBytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return static_cast<uint64_t>(usage.ru_maxrss) * 1024;
}

void RunContext::warn(const std::string& line) {
    warnings_.push_back(line);
    log(LogLevel::Warning, line);
}

void RunContext::checkInterrupt() const {
    if (interruptSignal != 0) throw Interrupted(interruptSignal);
}

PhaseTimer::PhaseTimer(RunContext& run, std::string name)
    : run_(run), name_(std::move(name)), wall_(wallSeconds()), cpu_(cpuSeconds()) {}

PhaseTimer::~PhaseTimer() { run_.phases.push_back({name_, wallSeconds() - wall_, cpuSeconds() - cpu_}); }

}  // namespace lsde
