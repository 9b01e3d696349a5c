// A progress bar with the time left, on terminals only.
#pragma once

#include <unistd.h>

#include <cstdio>
#include <string>

#include "base/run.h"

namespace lsde {

class ProgressBar {
  public:
    void show(const Progress& p) {
        if (!terminal_) return;
        const double now = wallSeconds();
        if (p.phase != phase_) {
            phase_ = p.phase;
            start_ = now;
        } else if (now - shown_ < 0.1 && p.done < 1) {
            return;
        }
        shown_ = now;
        const double left = p.done > 0 ? (now - start_) * (1 / p.done - 1) : 0;
        const int filled = static_cast<int>(30 * p.done);
        std::string bar(30, '-');
        for (int i = 0; i < filled && i < 30; ++i) bar[static_cast<size_t>(i)] = '#';
        std::fprintf(stderr, "\r%-8s [%s] %3.0f%%  %.0f s left   ", phase_.c_str(), bar.c_str(), 100 * p.done, left);
        std::fflush(stderr);
        visible_ = true;
    }
    // Before a line of log.
    void clear() {
        if (visible_) std::fprintf(stderr, "\r%70s\r", "");
        visible_ = false;
    }
    ~ProgressBar() { clear(); }

  private:
    bool terminal_ = isatty(STDERR_FILENO) != 0;
    bool visible_ = false;
    std::string phase_;
    double start_ = 0, shown_ = 0;
};

}  // namespace lsde
