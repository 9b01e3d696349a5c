// Errors that a user can mend, and assertions for those that only we can.
#pragma once

#include <stdexcept>
#include <string>

namespace lsde {

// Bad input: one line that names file, object, value and what was expected. Exit code 1.
class Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

// Wrong usage of the command line. Exit code 2.
class UsageError : public Error {
  public:
    using Error::Error;
};

// The user interrupted the run (SIGINT, SIGTERM), at a point where what was finished is saved.
class Interrupted : public Error {
  public:
    explicit Interrupted(int signalNumber) : Error("interrupted"), signal(signalNumber) {}
    int signal;
};

[[noreturn]] void assertionFailed(const char* expression, const char* file, int line);

}  // namespace lsde

// On in every build without NDEBUG (dev, tsan, ci).
#ifdef NDEBUG
#define LSDE_ASSERT(expression) static_cast<void>(0)
#else
#define LSDE_ASSERT(expression) \
    static_cast<void>((expression) || (::lsde::assertionFailed(#expression, __FILE__, __LINE__), false))
#endif
