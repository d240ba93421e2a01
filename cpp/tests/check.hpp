#pragma once
// A small harness for the core's checks. Named checks register themselves. A failed condition
// prints its location and its values, and the check continues. Conditions are evaluated only on the
// main thread.

#include <cmath>
#include <exception>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace jointid::tests {

using Body = void (*)();

struct Named {
  std::string_view name;
  Body body;
};

/// All named checks of the program, in the order of the files.
std::vector<Named>& registered();

struct Registration {
  Registration(std::string_view name, Body body) { registered().push_back({name, body}); }
};

/// Prints file, line and the difference if `holds` is false.
void expect(bool holds, const char* text, const std::string& values, const char* file, int line);

template <class First, class Second>
void expect_close(const First& a, const Second& b, double tolerance, const char* text,
                  const char* file, int line) {
  const auto first = static_cast<double>(a);
  const auto second = static_cast<double>(b);
  const double difference = std::fabs(first - second);
  std::ostringstream values;
  values.precision(17);
  values << a << " against " << b << ", apart " << difference << ", tolerance " << tolerance;
  expect(first == second || difference <= tolerance, text, values.str(), file, line);
}

/// The message that the call throws as Exception; empty (and a failure) if it does not throw.
template <class Exception, class Call>
std::string message_of(Call call, const char* text, const char* file, int line) {
  std::string message;
  try {
    call();
    expect(false, text, "throws nothing", file, line);
  } catch (const Exception& error) {
    message = error.what();
    expect(!message.empty(), text, "throws without a message", file, line);
  }
  return message;
}

inline bool contains(const std::string& text, std::string_view part) {
  return text.find(part) != std::string::npos;
}

}  // namespace jointid::tests

#define JOINTID_JOIN_AGAIN(a, b) a##b
#define JOINTID_JOIN(a, b) JOINTID_JOIN_AGAIN(a, b)

/// A named check: CHECK_CASE("room: promise") { ... }
#define CHECK_CASE(name) JOINTID_CHECK_CASE(name, __COUNTER__)
#define JOINTID_CHECK_CASE(name, number)                                           \
  static void JOINTID_JOIN(check_, number)();                                      \
  static const ::jointid::tests::Registration JOINTID_JOIN(registration_, number){ \
      name, JOINTID_JOIN(check_, number)};                                         \
  static void JOINTID_JOIN(check_, number)()

#define CHECK(condition) ::jointid::tests::expect((condition), #condition, "", __FILE__, __LINE__)
/// With a text to print if it fails: CHECK_WITH(a < b, "seed " + std::to_string(seed))
#define CHECK_WITH(condition, values) \
  ::jointid::tests::expect((condition), #condition, (values), __FILE__, __LINE__)
#define CHECK_CLOSE(a, b, tolerance) \
  ::jointid::tests::expect_close((a), (b), (tolerance), #a " ~ " #b, __FILE__, __LINE__)
/// The expression must throw std::invalid_argument with `part` in its message.
#define CHECK_REFUSED(expression, part)                                                      \
  do {                                                                                       \
    const std::string refusal_message = ::jointid::tests::message_of<std::invalid_argument>( \
        [&] { static_cast<void>(expression); }, #expression, __FILE__, __LINE__);            \
    CHECK_WITH(::jointid::tests::contains(refusal_message, part), refusal_message);          \
  } while (false)
