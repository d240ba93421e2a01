#include "check.hpp"

#include <chrono>
#include <cstdio>
#include <cstdlib>

namespace jointid::tests {

namespace {

int failures_here = 0;  // conditions that failed in the running check

}  // namespace

std::vector<Named>& registered() {
  static std::vector<Named> checks;
  return checks;
}

void expect(bool holds, const char* text, const std::string& values, const char* file, int line) {
  if (holds) return;
  ++failures_here;
  constexpr int kEnough = 20;  // a failing condition in a loop must not fill the screen
  if (failures_here > kEnough) return;
  std::printf("%s:%d: %s%s%s\n", file, line, text, values.empty() ? "" : "\n    ", values.c_str());
}

namespace {

bool passes(const Named& check) {
  failures_here = 0;
  const auto start = std::chrono::steady_clock::now();
  try {
    check.body();
  } catch (const std::exception& error) {
    expect(false, "ended by an exception", error.what(), check.name.data(), 0);
  } catch (...) {
    expect(false, "ended by an exception", "not a std::exception", check.name.data(), 0);
  }
  const std::chrono::duration<double> spent = std::chrono::steady_clock::now() - start;
  std::printf("%-6s %6.2f s  %s\n", failures_here == 0 ? "passed" : "FAILED", spent.count(),
              check.name.data());
  std::fflush(stdout);
  return failures_here == 0;
}

}  // namespace

}  // namespace jointid::tests

/// core_check [part of a name]: runs all checks, or those whose name contains the part.
int main(int argc, char** argv) {
  const std::string_view part = argc > 1 ? argv[1] : "";
  int passed = 0;
  int failed = 0;
  for (const auto& check : jointid::tests::registered()) {
    if (check.name.find(part) == std::string_view::npos) continue;
    ++(jointid::tests::passes(check) ? passed : failed);
  }
  if (passed + failed == 0) {
    std::printf("no check is named like '%s'\n", argv[1]);
    ++failed;
  }
  std::printf("%d passed, %d failed\n", passed, failed);
  return failed == 0 ? EXIT_SUCCESS : EXIT_FAILURE;
}
