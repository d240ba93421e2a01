#include "check.hpp"

#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>

// Where the C library can be asked, threads are counted, so that no check that starts one is kept
// from ThreadSanitizer. Sanitizers look at the same call themselves.
#if defined(__GLIBC__) && !defined(JOINTID_SANITIZED)
#define JOINTID_COUNTS_THREADS
#include <dlfcn.h>
#include <pthread.h>
#endif

namespace jointid::tests {

namespace {

int failures_here = 0;              // conditions that failed in the check that runs
std::atomic<int> threads_here = 0;  // that it has started, where they are counted

}  // namespace

std::vector<Named>& registered() {
  static std::vector<Named> checks;
  return checks;
}

void expect(bool holds, const char* text, const std::string& values, const char* file, int line) {
  if (holds) return;
  ++failures_here;
  constexpr int kEnough = 20;  // a condition in a loop need not fill the screen
  if (failures_here > kEnough) return;
  std::printf("%s:%d: %s%s%s\n", file, line, text, values.empty() ? "" : "\n    ", values.c_str());
}

namespace {

bool passes(const Named& check) {
  failures_here = 0;
  threads_here = 0;
  const auto start = std::chrono::steady_clock::now();
  try {
    check.body();
  } catch (const std::exception& error) {
    expect(false, "ended by an exception", error.what(), check.name.data(), 0);
  } catch (...) {
    expect(false, "ended by an exception", "not a std::exception", check.name.data(), 0);
  }
  if (threads_here > 0 && !check.threaded) {
    expect(false, "starts threads, so it is a THREADED_CASE", "", check.name.data(), 0);
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  std::printf("%-6s %6.2f s  %s\n", failures_here == 0 ? "passed" : "FAILED", spent.count(),
              check.name.data());
  std::fflush(stdout);
  return failures_here == 0;
}

}  // namespace

void count_thread() {
  ++threads_here;
}

}  // namespace jointid::tests

#ifdef JOINTID_COUNTS_THREADS
/// In the place of the C library's, which it calls.
extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*work)(void*), void* argument) {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  jointid::tests::count_thread();
  return create(thread, attributes, work, argument);
}
#endif

/// core_check [part of a name]: runs all checks, or those whose name contains the part.
int main(int argc, char** argv) {
  const std::string_view part = argc > 1 ? argv[1] : "";
  int passed = 0;
  int failed = 0;
  for (const auto& check : jointid::tests::registered()) {
    if (check.name.find(part) == std::string_view::npos) continue;
#ifdef JOINTID_ONLY_THREADED
    if (!check.threaded) continue;
#endif
    ++(jointid::tests::passes(check) ? passed : failed);
  }
  if (passed + failed == 0) {
    std::printf("no check is named like '%s'\n", argv[1]);
    ++failed;
  }
  std::printf("%d passed, %d failed\n", passed, failed);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
