// What a pass gets from its caller besides its input: seed, threads, log, progress, clock, counters, cancellation.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "base/parallel.h"

namespace lsde {

// Wall and CPU seconds (of all threads) since the process started.
double wallSeconds();
double cpuSeconds();
uint64_t peakMemoryBytes();

enum class LogLevel : uint8_t { Debug, Info, Warning };

struct Progress {
    std::string phase;
    double done = 0;  // in [0,1]
};

struct PhaseTime {
    std::string name;
    double wall = 0;  // s
    double cpu = 0;   // s, all threads
};

// One run of the program. Passed down by reference; owns nothing global.
class RunContext {
  public:
    explicit RunContext(int threads = 0, uint64_t runSeed = 0) : pool(threads), seed(runSeed) {}

    ThreadPool pool;
    uint64_t seed;
    std::function<void(LogLevel, const std::string&)> onLog;
    std::function<void(const Progress&)> onProgress;
    std::atomic<int> interruptSignal{0};  // set by the signal handler
    std::atomic<uint64_t> rays{0};
    std::vector<PhaseTime> phases;

    void debug(const std::string& line) const { log(LogLevel::Debug, line); }
    void info(const std::string& line) const { log(LogLevel::Info, line); }
    // A warning is kept too, so that results can carry it.
    void warn(const std::string& line);
    const std::vector<std::string>& warnings() const { return warnings_; }

    void progress(const std::string& phase, double done) const {
        if (onProgress) onProgress({phase, done});
    }
    bool interrupted() const { return interruptSignal != 0; }
    // Throws Interrupted if the user has asked to stop.
    void checkInterrupt() const;

  private:
    void log(LogLevel level, const std::string& line) const {
        if (onLog) onLog(level, line);
    }
    std::vector<std::string> warnings_;
};

// Adds a phase's times to the run when it goes out of scope.
class PhaseTimer {
  public:
    PhaseTimer(RunContext& run, std::string name);
    ~PhaseTimer();
    PhaseTimer(const PhaseTimer&) = delete;
    PhaseTimer& operator=(const PhaseTimer&) = delete;

  private:
    RunContext& run_;
    std::string name_;
    double wall_, cpu_;
};

}  // namespace lsde
